#include "experiments/measure/flip.h"

#include "engine/core/check.h"
#include "experiments/images/colour.h"
#include "experiments/measure/ldr_flip.h"
#include "experiments/measure/pixel_errors.h"
#include "experiments/measure/statistics.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace qtrace::experiments {
namespace {

// Narkowicz's fit x (a x + b) / (x (c x + d) + e), with x = 0.6 times the radiance.
constexpr double kA = 0.6 * 0.6 * 2.51, kB = 0.6 * 0.03, kC = 0.6 * 0.6 * 2.43, kD = 0.6 * 0.59, kE = 0.14;

// The positive solution of aces(x) = t: (a - c t) x^2 + (b - d t) x - e t = 0.
double aces_inverse(double t) {
  const double half = 0.5 * (kB - kD * t) / (kA - kC * t);
  return -half + std::sqrt(half * half + kE * t / (kA - kC * t));
}

glm::dvec3 shown(const glm::dvec3& radiance) { return glm::max(radiance, 0.0); }

DisplayImage tone_map(const RadianceImage& image, const std::vector<glm::dvec3>& pixels, double stops) {
  const double scale = std::exp2(stops);
  DisplayImage display{image.width, image.height, {}};
  display.pixels.reserve(pixels.size());
  for (const glm::dvec3& pixel : pixels) {
    const glm::dvec3 x = scale * pixel;
    display.pixels.emplace_back(aces(x.r), aces(x.g), aces(x.b));
  }
  return display;
}

}  // namespace

double aces(double x) {
  if (x > 1e100) return 1;  // its square might overflow
  return std::clamp(x * (kA * x + kB) / (x * (kC * x + kD) + kE), 0.0, 1.0);
}

Exposures flip_exposures(const RadianceImage& reference) {
  std::vector<double> values, positive;
  for (const glm::dvec3& pixel : reference.mean) {
    if (!is_finite(pixel)) continue;
    values.push_back(luminance(shown(pixel)));
    if (values.back() > 0) positive.push_back(values.back());
  }
  if (positive.empty()) return {};
  const double brightest = *std::max_element(positive.begin(), positive.end());
  double median = *quantile(std::move(values), 0.5);
  if (median == 0) median = *quantile(std::move(positive), 0.5);
  const double target = aces_inverse(kToneAtEnds);
  Exposures exposures{std::log2(target / brightest), std::log2(target / median), 1};
  if (exposures.first < exposures.last) {
    exposures.count = std::max(2, static_cast<int>(std::ceil(exposures.last - exposures.first)));
  }
  return exposures;
}

std::vector<double> flip_map(const RadianceImage& image, const RadianceImage& reference) {
  check_same_size(image, reference);
  std::vector<glm::dvec3> a, r;
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    const bool finite = is_finite(image.mean[i]) && is_finite(reference.mean[i]);
    r.push_back(is_finite(reference.mean[i]) ? shown(reference.mean[i]) : glm::dvec3(0.0));
    a.push_back(finite ? shown(image.mean[i]) : r.back());
  }
  const Exposures exposures = flip_exposures(reference);
  std::vector<double> largest(image.pixels(), 0.0);
  for (int i = 0; i < exposures.count; ++i) {
    const double stops = exposures.stops(i);
    const std::vector<double> errors = ldr_flip(tone_map(reference, r, stops), tone_map(image, a, stops));
    for (std::size_t p = 0; p < errors.size(); ++p) largest[p] = std::max(largest[p], errors[p]);
  }
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    if (!is_finite(image.mean[i]) || !is_finite(reference.mean[i])) {
      largest[i] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return largest;
}

double flip_error(const RadianceImage& image, const RadianceImage& reference) {
  return finite_mean(flip_map(image, reference));
}

}  // namespace qtrace::experiments
