// Errors per pixel as a picture: false colours in PNG, or the values themselves in OpenEXR.
#pragma once

#include "experiments/measure/metrics.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace qtrace::experiments {

// Which error has which colour. Errors below and above have the colour of the end.
struct HeatScale {
  double bottom = 0;  // black; above zero the scale is logarithmic, else linear
  double top = 1;     // pale yellow
  std::size_t above = 0;
  std::size_t not_finite = 0;  // green, a colour that magma does not have
};

constexpr double kHeatQuantile = 0.99;
constexpr double kHeatDecades = 4;  // of squared errors, whose noise spans many; others are linear from 0

// One that is scaled to one (FLIP) ends at 1. Others: at `top` where it is given, else at the 99th percentile
// of the finite values (their largest where that is 0), as a few fireflies would leave the rest of a map
// black.
HeatScale heat_scale(HeatScaling scaling, const std::vector<double>& errors, double top = 0);

// 8-bit RGB, three bytes a pixel.
std::vector<std::uint8_t> heat_colours(const std::vector<double>& errors, const HeatScale& scale);

// Throws Error unless the name ends in .png or .exr.
void check_heat_file(const std::filesystem::path& file);

// False colours, or with .exr the values in a channel Y, with metric and scale in the metadata. Whole or not
// at all. Throws Error that names the file.
void write_heat_map(const std::filesystem::path& file, const Metric& metric, int width, int height,
                    const std::vector<double>& errors, const HeatScale& scale);

}  // namespace qtrace::experiments
