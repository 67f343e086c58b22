// log.txt: what a long job said, with the time, for the morning after.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>

namespace qtrace::experiments {

class LogFile {
 public:
  // Appends to the file; the name of the process stands in its first line. Where it cannot be written,
  // nothing is.
  explicit LogFile(const std::filesystem::path& file);
  ~LogFile();
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;

  void line(const std::string& text);  // "2026-05-01T22:13:00Z text", at once

 private:
  std::FILE* stream_ = nullptr;
};

}  // namespace qtrace::experiments
