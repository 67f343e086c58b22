// HDR-FLIP: Andersson, Nilsson, Shirley, Akenine-Moller 2021, Visualizing errors in rendered high dynamic
// range images (Eurographics short papers). Both images are shown at many exposures; a pixel's error is its
// largest.
#pragma once

#include "engine/core/image.h"

#include <vector>

namespace qtrace::experiments {

constexpr double kToneAtEnds = 0.85;  // t_max = t_min: what the ends of the exposures are mapped to

// Stops, from the reference alone: the shortest shows its brightest pixel at kToneAtEnds, the longest its
// median (of the positive luminances, where half of the image or more is black).
struct Exposures {
  double first = 0;
  double last = 0;
  int count = 1;  // one a stop, at least two; a single one where first = last
  double stops(int i) const { return count == 1 ? first : first + i * (last - first) / (count - 1); }
};
Exposures flip_exposures(const RadianceImage& reference);

// The filmic curve of ACES as fitted by Narkowicz 2015, without its pre-exposure; in [0, 1].
double aces(double radiance);

// Per pixel in [0, 1]; NaN where image or reference is not finite. Such pixels are taken for equal, so that
// their neighbours do not suffer; negative radiance counts as 0. Throws Error where the sizes differ.
std::vector<double> flip_map(const RadianceImage& image, const RadianceImage& reference);

// The mean of the finite pixels of flip_map; NaN if there is none.
double flip_error(const RadianceImage& image, const RadianceImage& reference);

}  // namespace qtrace::experiments
