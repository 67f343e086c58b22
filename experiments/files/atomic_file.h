// Files that are there whole or not at all: written under a temporary name in the same folder, flushed to
// the disk and renamed.
#pragma once

#include "engine/core/check.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace qtrace::experiments {

// There is no room left for a file. Nothing that was there before is damaged.
class DiskFull : public Error {
 public:
  using Error::Error;
};

// Throws DiskFull where the file system of `target` has no room, else Error; both name the target.
[[noreturn]] void fail_to_write(const std::filesystem::path& target, const std::string& reason);

// For writers that want a path of their own, like OpenEXR. Without commit() the target stays untouched.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();  // removes the temporary file unless committed
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }
  // Each throws Error that names the target.
  void commit();  // flushes the content to the disk and renames the file
  void rename();  // of content that was flushed before

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
};

// Writes a file as it is, neither whole nor safe. Throws Error that names it.
void write_bytes(const std::filesystem::path& file, std::string_view content);

// Waits until the content of these files of one file system is on the disk. Throws Error that names one.
void flush_to_disk(const std::vector<std::filesystem::path>& files);

// Replaces the file's content. Throws Error that names it, and then the old content is still there.
void write_file(const std::filesystem::path& target, std::string_view content);

// Whether there is such a file. A name that no file can have, as one that is too long, is no error.
bool is_file(const std::filesystem::path& file);

// Reads a whole file. Throws Error that names it.
std::string read_file(const std::filesystem::path& file);

// Removes what killed processes left behind below `folder` of files that they had not finished. No other
// process may be writing there.
void remove_unfinished_files(const std::filesystem::path& folder);

// Of this machine: what tells processes apart on a shared file system, together with their numbers.
std::string host_name();

// Makes the folder and those above it. Throws Error that names it.
void make_folder(const std::filesystem::path& folder);

}  // namespace qtrace::experiments
