// Whether two noisy images of the same size show the same.
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace qtrace::independent {

// Square, row by row; pixels are independent of one another.
struct Difference {
  std::vector<glm::dvec3> mean;      // of one image less the other
  std::vector<glm::dvec3> variance;  // of that difference
  std::vector<glm::dvec3> scale;     // radiance, to which rounding is relative
};

// 1 but for chance, if the images are the same.
struct Chi2 {
  double value = 1;
  double error = 0;  // its standard error
};

// Chi-square per square of cell x cell pixels. An image's own samples tell too little noise where few paths
// bring most of the light, and tell least where those paths are missed and the difference is large; (a - b)^2
// / (var a + var b) is then too large in the mean, by 2 g^2 / n for samples of skewness g. So the squares of
// pool x pool cells are summed before they are divided by the sum of the variances, which for as many
// independent cells divides that part by pool^4. Mean over pools, and over channels.
Chi2 pooled_chi2(const Difference& difference, int cell, int pool);

struct Agreement {
  Chi2 pixels;  // per pixel, averaged over blocks of kBlock x kBlock: sees wrong variances as well
  Chi2 blocks;  // of the means of such blocks: sees errors that neighbours share
  // Of the images' means, the renderer's over the tracer's. Pixels in which a light's edge is seen are left
  // out: nearly all of their noise, and up to nine tenths of that of the whole, is where in the pixel samples
  // fall.
  double mean_ratio = 0;
  double mean_ratio_error = 0;
  int frames = 0;  // of the renderer
  std::uint64_t non_finite = 0;

  bool agrees(double chance) const;  // all figures are 1, up to their errors
  std::string text() const;
};

inline constexpr int kBlock = 4;
inline constexpr int kBlocksInPool = 2;  // each way

}  // namespace qtrace::independent
