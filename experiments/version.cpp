#include "experiments/version.h"

#include <qtrace_commit.h>  // written by every build, see cmake/write_commit.cmake

namespace qtrace::experiments {

std::string version() { return QTRACE_VERSION; }

std::string commit() { return QTRACE_COMMIT; }

std::string software() { return "qtrace " + version() + " (" + commit() + ")"; }

}  // namespace qtrace::experiments
