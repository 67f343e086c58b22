// Which program wrote a file.
#pragma once

#include <string>

namespace qtrace::experiments {

std::string version();   // "0.1.0"
std::string commit();    // git's description when the build was configured, or "unknown"
std::string software();  // "qtrace 0.1.0 (commit)"

}  // namespace qtrace::experiments
