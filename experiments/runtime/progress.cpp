#include "experiments/runtime/progress.h"

#include "experiments/files/atomic_file.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace qtrace::experiments {
namespace {

constexpr std::chrono::milliseconds kLiveInterval{100};
constexpr std::chrono::seconds kLineInterval{10};
constexpr std::chrono::seconds kStateInterval{1};
constexpr const char* kClearLine = "\r\x1b[K";

std::size_t terminal_columns() {
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

}  // namespace

Json to_json(const ProgressState& state) {
  return {{"label", state.label},
          {"frame", state.frame},
          {"frames", state.frames},
          {"relmse", state.relmse},
          {"stage_left_s", state.stage_left_s},
          {"all_left_s", state.all_left_s}};
}

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
  relmse_.reset();
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
  if (relmse) relmse_ = relmse;
  const auto now = Clock::now();
  const bool is_live = mode_ == Mode::live;
  const bool shows =
      now - last_shown_ >= (is_live ? Clock::duration(kLiveInterval) : Clock::duration(kLineInterval));
  const bool writes = !state_file_.empty() && now - state_written_ >= kStateInterval;
  if (!shows && !writes) return;
  const double stage_left = seconds_left((frames_ - frame_) * work_per_frame_);
  const double all_left = seconds_left(planned_ - done_ - (frame_ - first_) * work_per_frame_);
  if (writes) write_state({label_, frame_, frames_, relmse_.value_or(-1), stage_left, all_left});
  if (!shows) return;
  last_shown_ = now;
  show(fmt::format("{}: frame {}/{}{}, {} left of this, {} of all", label_, frame_, frames_,
                   relmse_ ? fmt::format(", relMSE {:.3g}", *relmse_) : "", duration_text(stage_left),
                   duration_text(all_left)),
       is_live);
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

void Progress::note(const std::string& line) {
  if (log_) log_->line(line);
  show(line, false);
}

void Progress::warning(const std::string& line) {
  if (log_) log_->line("warning: " + line);
  if (mode_ == Mode::live) std::fputs(kClearLine, stderr);
  fmt::print(stderr, "warning: {}\n", line);
}

void Progress::keep_in(const std::filesystem::path& folder, const std::string& part) {
  const std::string suffix = part.empty() ? "" : "-" + part;
  log_ = std::make_unique<LogFile>(folder / fmt::format("log{}.txt", suffix));
  state_file_ = folder / fmt::format("{}{}.json", kProgressFile, suffix);
}

void Progress::forget() {
  std::error_code ignored;
  if (!state_file_.empty()) std::filesystem::remove(state_file_, ignored);
  state_file_.clear();
  log_.reset();
}

// Whole or not at all, but not flushed to the disk: it is of no use after a crash. Nothing depends on it.
void Progress::write_state(const ProgressState& state) {
  state_written_ = Clock::now();
  try {
    AtomicFile file(state_file_);
    write_bytes(file.temporary(), to_json(state).dump());
    file.rename();
  } catch (const Error&) {
    state_file_.clear();
  }
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
