#include "experiments/version.h"

// CMake defines both for this file alone; builds without it or without git still work.
#ifndef QTRACE_VERSION
#define QTRACE_VERSION "unknown"
#endif
#ifndef QTRACE_COMMIT
#define QTRACE_COMMIT "unknown"
#endif

namespace qtrace::experiments {

std::string version() { return QTRACE_VERSION; }

std::string commit() { return *QTRACE_COMMIT == '\0' ? "unknown" : QTRACE_COMMIT; }

std::string software() { return "qtrace " + version() + " (" + commit() + ")"; }

}  // namespace qtrace::experiments
