// Where a long job stands: on a terminal one line that updates itself, elsewhere plain lines.
#pragma once

#include "experiments/files/json.h"
#include "experiments/runtime/log_file.h"

#include <chrono>
#include <memory>
#include <optional>
#include <string>

namespace qtrace::experiments {

// "8 s", "3 min 05 s", "2 h 07 min".
std::string duration_text(double seconds);

// What a process at work tells of itself, in .progress.json or, of a shard, .progress-2-of-4.json.
inline constexpr const char* kProgressFile = ".progress";
struct ProgressState {
  std::string label;  // of the run or reference
  int frame = 0;
  int frames = 0;
  double relmse = -1;  // below 0: not known yet
  double stage_left_s = 0;
  double all_left_s = 0;
};

Json to_json(const ProgressState& state);

class Progress {
 public:
  enum class Mode { quiet, lines, live };

  // live if standard error is a terminal, else lines; quiet if asked for.
  static Mode detect(bool quiet);

  explicit Progress(Mode mode) : mode_(mode) {}

  // Work is counted in pixels times frames, which is what time grows with.
  void plan(double work) { planned_ += work; }

  // A stage of planned work, which ends with end() or with the next begin(); what it has not done by then
  // is no longer expected.
  // `first`: frames that are there already and were not planned.
  void begin(const std::string& label, int frames, double work_per_frame, int first = 0);
  void expect(int frames);  // the stage will end there instead
  void step(int frame, std::optional<double> relmse = {});
  void end();

  void note(const std::string& line);     // a line that stays, unless quiet
  void warning(const std::string& line);  // a line that stays, also if quiet

  // From now on, until forget(), notes and warnings are kept in `folder` as well (log.txt), and where the
  // work stands is told there to `qtrace status`. `part`: of a shard, its name; else empty.
  void keep_in(const std::filesystem::path& folder, const std::string& part);
  void forget();

 private:
  using Clock = std::chrono::steady_clock;

  double seconds_left(double work) const;
  void show(const std::string& line, bool live);
  void write_state(const ProgressState& state);

  Mode mode_;
  double planned_ = 0;
  double done_ = 0;
  double busy_seconds_ = 0;  // in finished stages
  Clock::time_point stage_start_;
  Clock::time_point last_shown_;
  std::string label_;
  bool active_ = false;
  int frames_ = 0;
  int frame_ = 0;
  int first_ = 0;
  double work_per_frame_ = 0;
  std::optional<double> relmse_;  // last known of the stage
  std::unique_ptr<LogFile> log_;
  std::filesystem::path state_file_;  // empty: none
  Clock::time_point state_written_;
};

}  // namespace qtrace::experiments
