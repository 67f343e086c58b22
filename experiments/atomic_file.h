// Files that are there whole or not at all: written under a temporary name in the same folder, flushed to
// the disk and renamed.
#pragma once

#include <filesystem>
#include <string_view>

namespace qtrace::experiments {

// For writers that want a path of their own, like OpenEXR. Without commit() the target stays untouched.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();  // removes the temporary file unless committed
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }
  void commit();  // throws Error that names the target

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
};

// Replaces the file's content. Throws Error that names it, and then the old content is still there.
void write_file(const std::filesystem::path& target, std::string_view content);

// Reads a whole file. Throws Error that names it.
std::string read_file(const std::filesystem::path& file);

// Makes the folder and those above it. Throws Error that names it.
void make_folder(const std::filesystem::path& folder);

}  // namespace qtrace::experiments
