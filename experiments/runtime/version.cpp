#include "experiments/runtime/version.h"

#include "experiments/files/atomic_file.h"
#include "experiments/files/hash.h"

#include <qtrace_commit.h>  // written by every build, see cmake/write_commit.cmake

namespace qtrace::experiments {

std::string version() { return QTRACE_VERSION; }

std::string commit() { return QTRACE_COMMIT; }

std::string binary_hash() {
  static const std::string hash = hash_text(read_file("/proc/self/exe"));  // the file does not change
  return hash;
}

std::string software() { return "qtrace " + version() + " (" + commit() + ")"; }

}  // namespace qtrace::experiments
