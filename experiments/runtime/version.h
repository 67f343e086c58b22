// Which program wrote a file.
#pragma once

#include <string>

namespace qtrace::experiments {

std::string version();      // "0.1.0"
std::string commit();       // of the checkout when it was built, "-dirty" with local changes; or "unknown"
std::string binary_hash();  // of this program's own file, so that no two builds are taken for one
std::string software();     // "qtrace 0.1.0 (commit)"

}  // namespace qtrace::experiments
