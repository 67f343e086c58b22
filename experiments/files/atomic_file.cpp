#include "experiments/files/atomic_file.h"

#include "engine/core/check.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <fstream>
#include <iterator>
#include <vector>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTemporary = ".tmp";

// On a shared file system another machine may have a process of this number; and one process may have two
// files for one target on their way.
fs::path temporary_name(const fs::path& target) {
  static std::atomic<unsigned> count = 0;
  return target.parent_path() / fmt::format(".{}.{}.{}.{}{}", target.filename().string(), host_name(),
                                            ::getpid(), count++, kTemporary);
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

// A file system counts as full below this: one block is not enough for a file and its entry in the folder.
constexpr std::uintmax_t kNoRoom = 64 * 1024;

bool has_room(const fs::path& folder) {
  std::error_code error;
  const fs::space_info space = fs::space(folder.empty() ? fs::path(".") : folder, error);
  return error || space.available >= kNoRoom;
}

}  // namespace

void fail_to_write(const fs::path& target, const std::string& reason) {
  const std::string text = fmt::format("{}: cannot be written: {}", target.string(), reason);
  if (has_room(target.parent_path()) && reason != std::strerror(ENOSPC) && reason != std::strerror(EDQUOT)) {
    throw Error(text);
  }
  throw DiskFull(fmt::format("{}: cannot be written: the disk is full", target.string()));
}

AtomicFile::AtomicFile(fs::path target) : target_(std::move(target)), temporary_(temporary_name(target_)) {}

AtomicFile::~AtomicFile() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  if (!flush(temporary_)) fail_to_write(target_, std::strerror(errno));
  rename();
  // The rename itself; some file systems cannot flush folders, and the content is safe already.
  flush(target_.parent_path().empty() ? fs::path(".") : target_.parent_path());
}

void AtomicFile::rename() {
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error) fail_to_write(target_, error.message());
  temporary_.clear();
}

void write_bytes(const fs::path& file, std::string_view content) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  if (!stream.good()) fail_to_write(file, std::strerror(errno));
}

void flush_to_disk(const std::vector<fs::path>& files) {
  constexpr std::size_t kFew = 2;  // the whole file system may have more to flush than these files
  if (files.size() > kFew) {
    const int descriptor = ::open(files.front().c_str(), O_RDONLY | O_CLOEXEC);
    const bool flushed = descriptor >= 0 && ::syncfs(descriptor) == 0;
    const int error = errno;
    if (descriptor >= 0) ::close(descriptor);
    if (!flushed) fail_to_write(files.front(), std::strerror(error));
    return;
  }
  for (const fs::path& file : files) {
    if (!flush(file)) fail_to_write(file, std::strerror(errno));
  }
}

void write_file(const fs::path& target, std::string_view content) {
  AtomicFile file(target);
  try {
    write_bytes(file.temporary(), content);
  } catch (const DiskFull&) {
    fail_to_write(target, std::strerror(ENOSPC));
  } catch (const Error&) {
    fail_to_write(target, std::strerror(errno));
  }
  file.commit();
}

bool is_file(const fs::path& file) {
  std::error_code unreadable;
  return fs::is_regular_file(file, unreadable);
}

std::string read_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  check(stream.good() && !fs::is_directory(file), "{}: cannot be read; is it a file?", file.string());
  std::string content{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  check(!stream.bad(), "{}: cannot be read to its end", file.string());
  return content;
}

std::string host_name() {
  std::array<char, HOST_NAME_MAX + 1> name{};
  ::gethostname(name.data(), HOST_NAME_MAX);
  return name.data();
}

void remove_unfinished_files(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file() && name.starts_with('.') && name.ends_with(kTemporary)) {
      found.push_back(entry.path());
    }
  }
  std::error_code ignored;
  for (const fs::path& file : found) fs::remove(file, ignored);
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  check(!error && fs::is_directory(folder), "{}: cannot be made a folder: {}", folder.string(),
        error ? error.message() : "a file of that name is in the way");
}

}  // namespace qtrace::experiments
