#include "experiments/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace qtrace::experiments {
namespace {

constexpr std::chrono::milliseconds kLiveInterval{100};
constexpr std::chrono::seconds kLineInterval{10};
constexpr const char* kClearLine = "\r\x1b[K";

std::size_t terminal_columns() {
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

}  // namespace

std::string duration_text(double seconds) {
  const auto total = static_cast<long long>(std::max(0.0, seconds) + 0.5);
  if (total < 60) return fmt::format("{} s", total);
  if (total < 3600) return fmt::format("{} min {:02} s", total / 60, total % 60);
  return fmt::format("{} h {:02} min", total / 3600, total % 3600 / 60);
}

Progress::Mode Progress::detect(bool quiet) {
  if (quiet) return Mode::quiet;
  return ::isatty(STDERR_FILENO) == 1 ? Mode::live : Mode::lines;
}

void Progress::begin(const std::string& label, int frames, double work_per_frame, int first) {
  end();
  active_ = true;
  label_ = label;
  frames_ = frames;
  frame_ = first;
  first_ = first;
  work_per_frame_ = work_per_frame;
  stage_start_ = Clock::now();
  last_shown_ = stage_start_;
}

void Progress::expect(int frames) {
  planned_ += (frames - frames_) * work_per_frame_;
  frames_ = frames;
}

void Progress::step(int frame, std::optional<double> relmse) {
  frame_ = frame;
  const auto now = Clock::now();
  const bool live = mode_ == Mode::live;
  if (now - last_shown_ < (live ? Clock::duration(kLiveInterval) : Clock::duration(kLineInterval))) return;
  last_shown_ = now;
  const double stage_left = (frames_ - frame_) * work_per_frame_;
  const double all_left = planned_ - done_ - (frame_ - first_) * work_per_frame_;
  show(fmt::format("{}: frame {}/{}{}, {} left of this, {} of all", label_, frame_, frames_,
                   relmse ? fmt::format(", relMSE {:.3g}", *relmse) : "",
                   duration_text(seconds_left(stage_left)), duration_text(seconds_left(all_left))),
       live);
}

void Progress::end() {
  if (!active_) return;
  active_ = false;
  busy_seconds_ += std::chrono::duration<double>(Clock::now() - stage_start_).count();
  done_ += (frame_ - first_) * work_per_frame_;
  planned_ -= (frames_ - frame_) * work_per_frame_;
  frames_ = 0;
  frame_ = 0;
  first_ = 0;
}

void Progress::note(const std::string& line) { show(line, false); }

void Progress::warning(const std::string& line) {
  if (mode_ == Mode::live) std::fputs(kClearLine, stderr);
  fmt::print(stderr, "warning: {}\n", line);
}

double Progress::seconds_left(double work) const {
  const double done = done_ + (frame_ - first_) * work_per_frame_;
  const double seconds = busy_seconds_ + std::chrono::duration<double>(Clock::now() - stage_start_).count();
  return done > 0 ? work * seconds / done : 0;
}

void Progress::show(const std::string& line, bool live) {
  if (mode_ == Mode::quiet) return;
  if (mode_ == Mode::live) std::fputs(kClearLine, stderr);
  if (live) {
    std::fputs(line.substr(0, terminal_columns() - 1).c_str(), stderr);
  } else {
    fmt::print(stderr, "{}\n", line);
  }
  std::fflush(stderr);
}

}  // namespace qtrace::experiments
