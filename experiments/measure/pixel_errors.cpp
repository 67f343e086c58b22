#include "experiments/measure/pixel_errors.h"

#include "engine/core/check.h"

#include <glm/common.hpp>

#include <cmath>
#include <limits>

namespace qtrace::experiments {
bool is_finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

double channel_mean(const glm::dvec3& v) { return (v.x + v.y + v.z) / 3.0; }

double squared_error(const glm::dvec3& a, const glm::dvec3& r) { return channel_mean((a - r) * (a - r)); }

double relative_squared_error(const glm::dvec3& a, const glm::dvec3& r) {
  return channel_mean((a - r) * (a - r) / (r * r + kEpsilon));
}

double absolute_percentage_error(const glm::dvec3& a, const glm::dvec3& r) {
  return channel_mean(glm::abs(a - r) / (glm::abs(r) + kEpsilon));
}

double symmetric_percentage_error(const glm::dvec3& a, const glm::dvec3& r) {
  return channel_mean(glm::abs(a - r) / (glm::abs(a) + glm::abs(r) + kEpsilon));
}

void check_same_size(const RadianceImage& image, const RadianceImage& reference) {
  check(image.width == reference.width && image.height == reference.height,
        "an image of {}x{} pixels cannot be compared with a reference of {}x{}", image.width, image.height,
        reference.width, reference.height);
}

std::vector<double> map_errors(PixelError error, const RadianceImage& image, const RadianceImage& reference) {
  check_same_size(image, reference);
  std::vector<double> errors;
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    const glm::dvec3& a = image.mean[i];
    const glm::dvec3& r = reference.mean[i];
    errors.push_back(is_finite(a) && is_finite(r) ? error(a, r) : std::numeric_limits<double>::quiet_NaN());
  }
  return errors;
}

double finite_mean(const std::vector<double>& values) {
  double sum = 0;
  std::size_t count = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    sum += value;
    ++count;
  }
  return sum / static_cast<double>(count);
}

}  // namespace qtrace::experiments
