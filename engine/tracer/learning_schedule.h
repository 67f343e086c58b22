// When a table learns: which frames teach it, and after which its update runs. By the frame's number alone,
// so that a run which is taken up again goes on as if nobody had touched it.
#pragma once

#include "engine/core/rl_settings.h"

#include <cstdint>

namespace qtrace {

// Frames between two updates, at most; fewer where what they teach one entry would not fit its sum
// (limits.h).
inline constexpr std::uint32_t kMostFramesPerUpdate = 32;

class LearningSchedule {
 public:
  explicit LearningSchedule(const RlSettings& rl, std::uint32_t most_frames_per_update = kMostFramesPerUpdate)
      : teach_frames_(rl.teach_frames), growth_(rl.update_growth), most_(most_frames_per_update) {}

  // Whether frame `frame` (from 1) gathers targets: each of the first teach_frames, then a share of
  // teach_frames / frame, evenly spread.
  bool teaches(std::uint32_t frame) const;
  // Whether the table is updated after it.
  bool updates(std::uint32_t frame) const;

 private:
  int teach_frames_;
  double growth_;
  std::uint32_t most_;
};

}  // namespace qtrace
