#include "experiments/measure/heat_map.h"

#include "engine/core/check.h"
#include "experiments/files/atomic_file.h"
#include "experiments/images/exr.h"
#include "experiments/images/magma.h"
#include "experiments/measure/statistics.h"

#include <png.h>

#include <algorithm>
#include <cmath>

namespace qtrace::experiments {
namespace {

constexpr std::uint32_t kNotFinite = 0x00ff00;

// Between 0 at the bottom of the scale and 1 at its top.
double position(double error, const HeatScale& scale) {
  if (scale.bottom == 0) return error / scale.top;
  return std::log(std::max(error, scale.bottom) / scale.bottom) / std::log(scale.top / scale.bottom);
}

void write_png(const std::filesystem::path& file, int width, int height,
               const std::vector<std::uint8_t>& pixels) {
  AtomicFile target(file);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  if (png_image_write_to_file(&image, target.temporary().c_str(), 0, pixels.data(), 0, nullptr) == 0) {
    fail("{}: cannot be written: {}", file.string(), image.message);
  }
  target.commit();
}

}  // namespace

HeatScale heat_scale(HeatScaling scaling, const std::vector<double>& errors, double top) {
  HeatScale scale;
  std::vector<double> finite;
  std::copy_if(errors.begin(), errors.end(), std::back_inserter(finite),
               [](double error) { return std::isfinite(error); });
  scale.not_finite = errors.size() - finite.size();
  if (top > 0) {
    scale.top = top;
  } else if (scaling != HeatScaling::to_one && !finite.empty()) {
    scale.top = *quantile(finite, kHeatQuantile);
    if (scale.top == 0) scale.top = *std::max_element(finite.begin(), finite.end());
    if (scale.top == 0) scale.top = 1;
  }
  if (scaling == HeatScaling::logarithmic) scale.bottom = scale.top * std::pow(10, -kHeatDecades);
  scale.above = static_cast<std::size_t>(
      std::count_if(finite.begin(), finite.end(), [&](double error) { return error > scale.top; }));
  return scale;
}

std::vector<std::uint8_t> heat_colours(const std::vector<double>& errors, const HeatScale& scale) {
  std::vector<std::uint8_t> pixels;
  pixels.reserve(3 * errors.size());
  for (const double error : errors) {
    std::uint32_t colour = kNotFinite;
    if (std::isfinite(error)) {
      const double share = std::clamp(position(error, scale), 0.0, 1.0);
      colour = kMagma[static_cast<std::size_t>(std::lround(share * (kMagma.size() - 1)))];
    }
    for (const int shift : {16, 8, 0}) pixels.push_back(static_cast<std::uint8_t>(colour >> shift & 0xffU));
  }
  return pixels;
}

void check_heat_file(const std::filesystem::path& file) {
  check(file.extension() == ".png" || file.extension() == ".exr",
        "{}: a heat map is written as .png (false colours) or .exr (the values)", file.string());
}

void write_heat_map(const std::filesystem::path& file, const Metric& metric, int width, int height,
                    const std::vector<double>& errors, const HeatScale& scale) {
  check_heat_file(file);
  if (file.extension() == ".png") return write_png(file, width, height, heat_colours(errors, scale));
  ExrImage exr{width, height, {}, {}};
  exr.metadata = {{"metric", metric.name},
                  {"heatBottom", fmt::format("{}", scale.bottom)},
                  {"heatTop", fmt::format("{}", scale.top)}};
  exr.channels["Y"].assign(errors.begin(), errors.end());
  write_exr(file, exr);
}

}  // namespace qtrace::experiments
