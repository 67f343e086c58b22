// The renderer beside the independent tracer, on one scene.
#pragma once

#include "engine/core/image.h"
#include "engine/core/settings.h"
#include "tests/independent/path_tracer.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace qtrace::independent {

// All that are shipped, and the Cornell box in metal and plastic.
inline constexpr std::array kScenes{"simple.glb",      "occluded.glb", "cornell_box.glb",
                                    "many_lights.glb", "furnace.glb",  "glossy"};

// Chance that a true renderer fails one comparison.
inline constexpr double kQuickChance = 1e-4;

struct Agreement {
  // Mean over pixels and channels of (a - b)^2 / (var a + var b): 1 but for chance, if the images are the
  // same.
  double chi2_per_pixel = 0;
  double chi2_error = 0;  // its standard error
  // Of the images' means, the renderer's over the tracer's. Pixels in which a light's edge is seen are left
  // out: nearly all of their noise, and up to nine tenths of that of the whole, is where in the pixel samples
  // fall.
  double mean_ratio = 0;
  double mean_ratio_error = 0;
  int frames = 0;  // of the renderer
  std::uint64_t non_finite = 0;

  bool agrees(double chance) const;  // both figures are 1, up to their errors
  std::string text() const;
};

class Comparison {
 public:
  struct Size {
    int size;     // pixels each way
    int samples;  // of the independent tracer, at least
    // Doubled up to this many until the mean is known to half the variance that `precision` allows.
    int most_samples = 0;
    double precision = 0;
  };
  Comparison(const std::string& scene, Size size);

  int samples() const { return samples_; }  // of the independent tracer, per pixel

  // Renders at least `frames`, and on up to `most_frames` until the ratio of the means is known to
  // `precision`.
  Agreement measure(Sampler sampler, Nee nee, int frames, int most_frames = 0, double precision = 0) const;

 private:
  Agreement compare(const RadianceImage& image) const;
  double truth_error() const;  // of the mean, relative

  Scene scene_;
  Size size_;
  int samples_ = 0;
  Image truth_;
  std::vector<char> edges_;  // see edges_of_lights()
};

}  // namespace qtrace::independent
