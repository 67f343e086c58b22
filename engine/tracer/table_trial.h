// Whether a run's directions are drawn with the table: a trial before its first frame and, where that cannot
// tell, in later ones, by error times work.
#pragma once

#include "engine/core/image.h"
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
using HalfSums = std::array<std::vector<glm::vec3>, 2>;

// First a pilot (pilot.h): frames of a small picture that teach the table, then some of both kinds. As it
// counts nowhere else, a table that is given up leaves no trace in the image. Where the pilot cannot tell, up
// to two rounds follow among the image's frames, of which odd ones leave the table out and even ones use it.
// The first and the second half of a round are replicates with random numbers of their own, so that the
// squared difference of the two means of a pixel tells the error of either kind of frames, whatever the
// random numbers are. These frames count in the image, and a round decides about later frames only, which
// draw from new sequences: the mean stays without bias.
class TableTrial {
 public:
  // None where rl.trial_frames is 0, where directions are not learned, or where lights are, too: these need
  // the table anyway.
  explicit TableTrial(const RenderSettings& settings);

  bool is_wanted() const { return unit_ > 0; }

  // Of the pilot's frames, which count from 1, the first so many only teach; those after them are like a
  // round, but that they teach nothing.
  std::uint32_t pilot_lessons() const { return 2 * unit_; }
  std::uint32_t pilot_frames() const { return 6 * unit_; }
  bool pilot_is_without(std::uint32_t frame) const { return frame > pilot_lessons() && frame % 2 == 1; }
  bool looks_after_pilot(std::uint32_t frame) const;
  struct PilotLook {
    int width = 0;
    std::array<RadianceImage, 2> kinds;  // over the frames after the lessons, without the table and with it
    std::vector<HalfSums> sums;          // of these frames, after each where it looks
    std::array<FrameCounters, 2> counters;  // of the last frame of each kind
  };
  void look_at_pilot(const PilotLook& look);

  // Whether frame `frame` of the image (from 1) belongs to a round that takes place.
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

  // What was found last; nothing before the pilot.
  struct Finding {
    std::uint32_t frame = 0;  // after which; 0: in the pilot
    double gain = 1;          // error without the table over that with it, for the same number of frames
    double gain_error = 0;    // its standard error
    double found = 1;   // of the radiance that frames with the table found, what those without it did: far
                        // from 1 one of them misses light, and its error says nothing
    double work = 1;    // of a frame with the table over that of one without it
    double needed = 1;  // the gain from which on the table pays
  };
  const std::optional<Finding>& finding() const { return finding_; }
  bool gave_up() const { return verdict_ == Verdict::give_up; }
  bool is_decided() const { return verdict_ != Verdict::open; }

  // To go on with later.
  std::vector<std::byte> saved() const;
  void restore(std::span<const std::byte> saved);  // throws Error where it is none

 private:
  enum class Verdict : std::uint32_t { open, keep, give_up };
  // A round by the frames of the image after which its quarters begin and end. Its halves are replicates.
  struct Round {
    std::uint32_t begin, quarter, middle, three_quarters, end;
  };
  std::array<Round, 2> rounds() const;
  bool takes_place(const Round& round) const;
  void conclude(const Round& round, bool is_last, const Look& last);

  std::uint32_t unit_;  // rl.trial_frames; 0: no trial
  RandomNumbers random_;
  Verdict verdict_ = Verdict::open;
  std::optional<Finding> finding_;
  std::vector<HalfSums> sums_;  // of the round that goes on, at its quarters so far
  double work_without_ = 0;     // of a frame of the round
};

}  // namespace qtrace
