// Whether something that a run may do pays, by error times work: directions drawn with the table, or paths
// from the lights. A trial takes place before the first frame and, for a table with which that cannot tell,
// in later ones.
#pragma once

#include "engine/core/settings.h"
#include "engine/tracer/counters.h"
#include "engine/tracer/tried_sums.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace qtrace {

// What is tried is called the table here. First a pilot (pilot.h): frames of a small picture that teach the
// table, then some of both kinds. As it counts nowhere else, a table that is given up leaves no trace in the
// image. Where the pilot cannot tell, up to two rounds follow among the image's frames, of which odd ones
// leave the table out and even ones use it. Paths from the lights have nothing to learn: without lessons and
// rounds, the pilot decides. With Sobol' points, its pairs of frames belong to two sequences in turn, so that
// the squared difference of the two means of a pixel tells the error of either kind. The frames of a round
// count in the image, and it decides about later frames only, which draw from new sequences: the mean stays
// without bias.
class Trial {
 public:
  struct Plan {
    std::uint32_t unit = 0;     // frames; 0: no trial
    std::uint32_t lessons = 0;  // of the pilot, in units
    bool has_rounds = false;
    bool has_light_samples = true;  // or nothing tells that light is rarely found
  };
  Trial(const Plan& plan, RandomNumbers random) : plan_(plan), random_(random) {}

  bool is_wanted() const { return plan_.unit > 0; }

  // Of the pilot's frames, which count from 1, the first so many only teach; those after them are like a
  // round, but that they teach nothing. Where half of these suffice, the pilot ends (with a unit that is a
  // multiple of 4).
  std::uint32_t pilot_lessons() const { return plan_.lessons * plan_.unit; }
  std::uint32_t pilot_frames() const { return pilot_lessons() + 4 * plan_.unit; }
  bool pilot_is_without(std::uint32_t frame) const { return frame > pilot_lessons() && frame % 2 == 1; }
  bool looks_after_pilot(std::uint32_t frame) const { return frame > pilot_lessons() && frame % 2 == 0; }
  struct PilotLook {
    std::uint32_t frame = 0;
    int width = 0;
    HalfSums sums;                          // of the frames after the lessons
    std::array<FrameCounters, 2> counters;  // of the last frame of each kind
  };
  void look_at_pilot(PilotLook look);

  // Whether frame `frame` of the image (from 1) belongs to a round that takes place.
  bool is_tried(std::uint32_t frame) const;
  // Whether it leaves the table out: in a round, or after the table was given up.
  bool is_without(std::uint32_t frame) const;
  // The last frame up to `frame` after which a round begins or ends; 0 where there is none.
  std::uint32_t last_boundary(std::uint32_t frame) const;

  // Of a frame in the image, beside what it would weigh otherwise: in the first round, those without the
  // table weigh as much less as their error was larger in the pilot. Whether a second round takes place
  // depends on the image's own samples, and weights that do would make its mean biased.
  double weight(std::uint32_t frame) const;

  // What the trial is to see after some frames.
  struct Look {
    std::uint32_t frame = 0;
    std::array<double, 2> weights{1, 1};  // of the frame before it, which has no table, and of this one
    int width = 0;
    HalfSums sums;
    FrameCounters counters;  // of the frame
  };
  bool looks_after(std::uint32_t frame) const;
  void look(Look look);

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
  // A round by the frames of the image after which it begins and ends.
  struct Round {
    std::uint32_t begin, end;
  };
  std::array<Round, 2> rounds() const;
  bool takes_place(const Round& round) const;
  // What the frames tried so far say.
  Finding found(std::uint32_t frame, double work, int width) const;
  // `sharp`: the relative standard error of a gain with which it may give the table up.
  void judge_pilot(bool is_halfway, double sharp);
  void conclude(bool is_last);

  Plan plan_;
  RandomNumbers random_;
  Verdict verdict_ = Verdict::open;
  std::optional<Finding> finding_;
  double pilot_gain_ = 1;    // what the pilot found last
  TriedSums tried_;          // of the pilot or the round that goes on
  double work_without_ = 0;  // of a frame of the round
};

// None where rl.trial_frames is 0, where directions are not learned, or where lights are, too: these need the
// table anyway.
Trial trial_of_table(const RenderSettings& settings);

// None where light_path_trial is 0, or where there are no such paths.
Trial trial_of_light_paths(const RenderSettings& settings);

}  // namespace qtrace
