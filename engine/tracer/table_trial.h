// Whether a run's directions go on being drawn with the table: a trial early in the run, by error times work.
#pragma once

#include "engine/core/settings.h"
#include "engine/tracer/counters.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace qtrace {

// Sums over the odd and over the even frames so far, pixel by pixel.
using HalfSums = std::array<std::vector<glm::dvec3>, 2>;

// Up to three rounds, until one can tell. In a round, odd frames leave the table out and even ones use it.
// Its first and its second half are replicates with random numbers of their own, so that the squared
// difference of the two means of a pixel, over twice the squared radiance around it, estimates the relative
// error of either kind of frames: as relMSE does, and whatever the random numbers are. All frames count in
// the image, and the trial decides about later frames only, which draw from new sequences: the mean stays
// without bias.
class TableTrial {
 public:
  // None where rl.trial_frames is 0, where directions are not learned, or where lights are, too: these need
  // the table anyway.
  explicit TableTrial(const RenderSettings& settings);

  bool is_wanted() const { return first_round_ > 0; }
  // Whether frame `frame` (from 1) belongs to a round that takes place.
  bool is_tried(std::uint32_t frame) const;
  // Whether it leaves the table out: in a round, or after the table was given up.
  bool is_without(std::uint32_t frame) const;
  // The last frame up to `frame` after which a replicate of the trial begins or ends; 0 where there is none.
  std::uint32_t last_boundary(std::uint32_t frame) const;

  // What the trial is to see after some frames.
  struct Look {
    std::uint32_t frame = 0;
    double weight = 1;  // of each frame of the round in the sums
    int width = 0;
    HalfSums sums;
    FrameCounters counters;  // of the frame
  };
  bool looks_after(std::uint32_t frame) const;
  void look(const Look& look);

  // What the last round found; nothing before the first has ended.
  struct Finding {
    std::uint32_t frame = 0;  // its last one
    double gain = 1;          // error without the table over that with it, for the same number of frames
    double gain_error = 0;    // its standard error
    double found = 1;  // of the radiance that frames with the table found, what those without it did: far
                       // below 1 they miss light, and their error says nothing
    double work = 1;  // of a frame with the table over that of one without it
  };
  const std::optional<Finding>& finding() const { return finding_; }
  bool gave_up() const { return verdict_ == Verdict::give_up; }
  bool is_decided() const { return verdict_ != Verdict::open; }

  // To go on with later.
  std::vector<std::byte> saved() const;
  void restore(std::span<const std::byte> saved);  // throws Error where it is none

 private:
  enum class Verdict : std::uint32_t { open, keep, give_up };
  struct Round {
    std::uint32_t begin, middle, end;  // frames after which its replicates begin and end
  };
  Round round(int number) const;
  std::optional<Round> round_of(std::uint32_t frame) const;  // that takes place
  bool takes_place(const Round& round) const;
  void conclude(const Round& round, int number, const Look& last);

  std::uint32_t first_round_;  // frames of the first round; 0: no trial
  Verdict verdict_ = Verdict::open;
  std::optional<Finding> finding_;
  std::vector<HalfSums> sums_;  // before the round that goes on, and between its halves
  double work_without_ = 0;     // of a frame of the round
};

}  // namespace qtrace
