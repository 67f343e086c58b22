// Whether a run's directions go on being drawn with the table: a trial early in the run, by the variance of
// its frames.
#pragma once

#include "engine/core/image.h"
#include "engine/core/settings.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace qtrace {

// The table is given up where frames without it have less than this times the variance of frames with it. A
// frame with the table costs 1.2 to 1.7 of one without, but it is tried early and is still learning.
inline constexpr double kLeastGain = 1.15;

// All frames count alike in the image, those of the trial as well, and the trial decides about later frames
// only: the mean stays without bias.
class TableTrial {
 public:
  // None where rl.trial_frames is 0, where directions are not learned, or where lights are, too: these need
  // the table anyway.
  explicit TableTrial(const RenderSettings& settings);

  bool is_wanted() const { return trial_frames_ > 0; }
  // Whether frame `frame` (from 1) leaves the table out: so many odd frames after the first 16, and all
  // frames once it was given up.
  bool is_without(std::uint32_t frame) const;

  // Before the trial's first frame, and after its last one, look() is to see the means of the odd and of the
  // even frames so far.
  bool looks_after(std::uint32_t frame) const;
  void look(const std::array<RadianceImage, 2>& halves);

  // Variance without the table over that with it, summed over pixels and channels, relative to the squared
  // radiance around (with the constant that relMSE has), without the 0.1 % of pixels with the most. Infinite
  // where the frames without it missed light that the others found, so that their variance says nothing.
  // Nothing before it is known.
  std::optional<double> gain() const { return gain_; }
  bool gave_up() const { return gain_ && *gain_ < kLeastGain; }

  // To go on with later.
  std::vector<std::byte> saved() const;
  void restore(std::span<const std::byte> saved);  // throws Error where it is none

 private:
  // Over frames of one kind, of every pixel.
  struct Sums {
    std::vector<glm::dvec3> values, squares;
  };
  static Sums sums_of(const RadianceImage& half);
  double gain_since(const std::array<RadianceImage, 2>& halves) const;

  std::uint32_t trial_frames_;
  std::array<Sums, 2> before_;  // of the odd and of the even frames before the trial, during it
  std::optional<double> gain_;
};

}  // namespace qtrace
