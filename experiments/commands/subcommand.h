// What every file of this folder adds to the command line.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace qtrace::experiments {

// Does what the command line asks for and returns the exit code.
using Action = std::function<int()>;

}  // namespace qtrace::experiments
