// Keeps two processes from writing the same files.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace qtrace::experiments {

// A lock on a file beside what it protects, by flock(2): it ends with the process, however that ends. On
// network file systems it holds between machines where flock does (NFS since Linux 2.6.12, Lustre with -o
// flock).
class FolderLock {
 public:
  enum class Kind { alone, shared };

  // Throws Error that names `what` and who holds the lock.
  FolderLock(const std::filesystem::path& file, Kind kind, const std::string& what);
  // Waits for it instead, alone; `poll` is called now and then on the way and may throw.
  static FolderLock wait(const std::filesystem::path& file, const std::function<void()>& poll);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  // "process 4711 on host" where some process holds the lock alone or shared, else empty.
  static std::string holder(const std::filesystem::path& file);

 private:
  explicit FolderLock(int descriptor) : descriptor_(descriptor) {}
  int descriptor_ = -1;
};

}  // namespace qtrace::experiments
