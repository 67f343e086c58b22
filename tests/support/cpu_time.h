// How long a computation takes, whatever else the machine does meanwhile.
#pragma once

#include <ctime>

namespace qtrace::test {

// Seconds of processors that this process has used so far.
inline double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace qtrace::test
