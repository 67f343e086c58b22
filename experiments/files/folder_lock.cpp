#include "experiments/files/folder_lock.h"

#include "engine/core/check.h"
#include "experiments/files/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kPause{50};  // between two attempts

int open_lock(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  check(descriptor >= 0, "{}: cannot be written: {}", file.parent_path().string(), std::strerror(errno));
  return descriptor;
}

bool try_lock(int descriptor, int operation) {
  int result = 0;
  do {
    result = ::flock(descriptor, operation | LOCK_NB);
  } while (result != 0 && errno == EINTR);
  return result == 0;
}

std::string read_all(int descriptor) {
  std::array<char, 512> text{};
  const ssize_t size = ::pread(descriptor, text.data(), text.size(), 0);
  return size > 0 ? std::string(text.data(), static_cast<std::size_t>(size)) : std::string();
}

std::string this_process() { return fmt::format("process {} on {}", ::getpid(), host_name()); }

// For messages alone: nothing depends on it.
void sign(int descriptor) {
  const std::string text = this_process();
  if (::ftruncate(descriptor, 0) != 0) return;
  [[maybe_unused]] const ssize_t written = ::pwrite(descriptor, text.data(), text.size(), 0);
}

}  // namespace

FolderLock::FolderLock(const fs::path& file, Kind kind, const std::string& what)
    : descriptor_(open_lock(file)) {
  if (!try_lock(descriptor_, kind == Kind::alone ? LOCK_EX : LOCK_SH)) {
    const std::string other = read_all(descriptor_);
    ::close(descriptor_);
    fail("{}: another qtrace ({}) is at work there; wait until it ends, or choose another folder by --out",
         what, other.empty() ? "unknown" : other);
  }
  sign(descriptor_);
}

FolderLock FolderLock::wait(const fs::path& file, const std::function<void()>& poll) {
  FolderLock lock(open_lock(file));
  while (!try_lock(lock.descriptor_, LOCK_EX)) {
    poll();
    std::this_thread::sleep_for(kPause);
  }
  sign(lock.descriptor_);
  return lock;
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

FolderLock::FolderLock(FolderLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

std::string FolderLock::holder(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return "";
  const bool is_free = try_lock(descriptor, LOCK_EX);
  const std::string text = is_free ? "" : read_all(descriptor);
  ::close(descriptor);
  return text;
}

}  // namespace qtrace::experiments
