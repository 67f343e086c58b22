#include "experiments/runtime/log_file.h"

#include "experiments/runtime/manifest.h"
#include "experiments/runtime/version.h"

#include <unistd.h>

namespace qtrace::experiments {

LogFile::LogFile(const std::filesystem::path& file) : stream_(std::fopen(file.c_str(), "a")) {
  line(fmt::format("{}, process {}", software(), ::getpid()));
}

LogFile::~LogFile() {
  if (stream_ != nullptr) std::fclose(stream_);
}

void LogFile::line(const std::string& text) {
  if (stream_ == nullptr) return;
  fmt::print(stream_, "{} {}\n", utc_now(), text);
  std::fflush(stream_);
}

}  // namespace qtrace::experiments
