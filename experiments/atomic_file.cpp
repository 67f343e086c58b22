#include "experiments/atomic_file.h"

#include "engine/core/check.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

fs::path temporary_name(const fs::path& target) {
  return target.parent_path() / fmt::format(".{}.{}.tmp", target.filename().string(), ::getpid());
}

// Flushes a file or a folder's list of names to the disk; false with errno where that fails.
bool flush(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool flushed = ::fsync(descriptor) == 0;
  const int error = errno;
  ::close(descriptor);
  errno = error;
  return flushed;
}

}  // namespace

AtomicFile::AtomicFile(fs::path target) : target_(std::move(target)), temporary_(temporary_name(target_)) {}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  check(flush(temporary_), "{}: cannot be written: {}", target_.string(), std::strerror(errno));
  std::error_code error;
  fs::rename(temporary_, target_, error);
  check(!error, "{}: cannot be written: {}", target_.string(), error.message());
  temporary_.clear();
  // The rename itself; some file systems cannot flush folders, and the content is safe already.
  flush(target_.parent_path().empty() ? fs::path(".") : target_.parent_path());
}

void write_file(const fs::path& target, std::string_view content) {
  AtomicFile file(target);
  std::ofstream stream(file.temporary(), std::ios::binary | std::ios::trunc);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  check(stream.good(), "{}: cannot be written: {}", target.string(), std::strerror(errno));
  file.commit();
}

std::string read_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  check(stream.good() && !fs::is_directory(file), "{}: cannot be read; is it a file?", file.string());
  std::string content{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  check(!stream.bad(), "{}: cannot be read to its end", file.string());
  return content;
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  check(!error && fs::is_directory(folder), "{}: cannot be made a folder: {}", folder.string(),
        error ? error.message() : "a file of that name is in the way");
}

}  // namespace qtrace::experiments
