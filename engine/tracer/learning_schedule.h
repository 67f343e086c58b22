// When a table learns: which frames teach it, and after which its update runs. By the frame's number alone,
// so that a run which is taken up again goes on as if nobody had touched it.
#pragma once

#include "engine/core/settings.h"

#include <cstdint>

namespace qtrace {

// Frames between two updates that come by rl.update_growth, at most.
inline constexpr std::uint32_t kMostFramesPerUpdate = 32;

class LearningSchedule {
 public:
  // `most_taught`: frames that one update can take the targets of (limits.h).
  LearningSchedule(const RenderSettings& settings, std::uint32_t most_taught)
      : teach_frames_(settings.rl.teach_frames),
        growth_(settings.rl.update_growth),
        doubles_(settings.random == RandomNumbers::sobol),
        most_taught_(most_taught) {}

  // Whether frame `frame` (from 1) gathers targets: each of the first teach_frames, then a share of
  // teach_frames / frame, evenly spread.
  bool teaches(std::uint32_t frame) const;
  // Whether the table is updated after it. With Sobol' points after frames 1, 2, 4, 8, ...: the frames
  // between two updates are then whole nets, which a table that changed within them would bias
  // (sample_sequence.h).
  bool updates(std::uint32_t frame) const { return frame > 0 && last_update(frame) == frame; }
  // The last frame up to `frame` after which it is; 0 where there is none.
  std::uint32_t last_update(std::uint32_t frame) const;

 private:
  double taught(double frame) const;
  std::uint32_t next_step(std::uint32_t update) const;

  int teach_frames_;
  double growth_;
  bool doubles_;
  std::uint32_t most_taught_;
};

}  // namespace qtrace
