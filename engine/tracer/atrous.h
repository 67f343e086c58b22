// The edge-avoiding à-trous filter as a post-process of rendered images: biased, and much less noisy.
// Dammertz, Sewtz, Hanika, Lensch 2010, "Edge-Avoiding À-Trous Wavelet Transform for fast Global Illumination
// Filtering", HPG.
#pragma once

#include "engine/core/filter_settings.h"
#include "engine/core/image.h"
#include "engine/gpu/buffer.h"
#include "engine/gpu/context.h"
#include "engine/gpu/program.h"

#include <vector>

namespace qtrace {

// Radiance is divided by albedo before and multiplied by it afterwards, so that textures stay sharp. A
// channel with an albedo below kLeastAlbedo is not divided, and mixes only with such channels.
//
// All scales are the image's own: radiance counts in means of the image, position in the spread (root mean
// square distance from their centre) of the visible points, so that units of light and length do not matter.
//
// A pixel whose centre sees a light or nothing, and one that is not finite, keeps its value and gives nothing
// to others. What antialiasing mixes into pixels at the edge of a light cannot be told from noise.
class AtrousFilter {
 public:
  static constexpr float kLeastAlbedo = 0.01F;

  // Compiles and warms up. The context must outlive the filter.
  AtrousFilter(const gpu::Context& context, const FirstHitImage& first_hit, const FilterSettings& settings);

  // The filtered mean; its variance is unknown and left empty. Waits. Throws Error where the size is another.
  RadianceImage apply(const RadianceImage& image);

 private:
  // Pixel by pixel what radiance is divided by.
  glm::dvec3 divisor(std::size_t pixel) const;
  bool takes_part(std::size_t pixel, const glm::dvec3& radiance) const;
  // Mean over pixels that take part and channels of radiance / albedo.
  double mean_level(const RadianceImage& image) const;
  void run_pass(int iteration);

  const gpu::Context& context_;
  FirstHitImage first_hit_;
  FilterSettings settings_;
  gpu::Buffer guides_;
  gpu::Buffer source_;
  gpu::Buffer result_;
  gpu::Buffer constants_;
  gpu::Program program_;
};

}  // namespace qtrace
