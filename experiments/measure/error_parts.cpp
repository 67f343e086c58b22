#include "experiments/measure/error_parts.h"

#include "experiments/measure/pixel_errors.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace qtrace::experiments {
namespace {

// Welford's running mean and sum of squares, per pixel.
struct Moments {
  std::vector<glm::dvec3> mean;
  std::vector<glm::dvec3> squares;
};

Moments pixel_moments(std::size_t seeds, const std::function<RadianceImage(std::size_t)>& image,
                      const RadianceImage& reference) {
  Moments moments{std::vector<glm::dvec3>(reference.pixels(), glm::dvec3(0)),
                  std::vector<glm::dvec3>(reference.pixels(), glm::dvec3(0))};
  for (std::size_t seed = 0; seed < seeds; ++seed) {
    const RadianceImage next = image(seed);
    check_same_size(next, reference);
    for (std::size_t i = 0; i < next.pixels(); ++i) {
      const glm::dvec3 step = next.mean[i] - moments.mean[i];
      moments.mean[i] += step / static_cast<double>(seed + 1);
      moments.squares[i] += step * (next.mean[i] - moments.mean[i]);
    }
  }
  return moments;
}

// The two sums that the estimates are made of, over the finite pixels.
struct Sums {
  double squared_error = 0;  // of the mean
  double variance = 0;       // of one run

  double bias2(std::size_t seeds, double pixels, double noise) const {
    return (squared_error - variance / static_cast<double>(seeds) - noise) / pixels;
  }
};

}  // namespace

double ErrorParts::abs_bias() const { return std::sqrt(std::max(bias2.mean, 0.0)); }

std::optional<double> ErrorParts::abs_bias_low() const {
  return bias2.low ? std::optional(std::sqrt(std::max(*bias2.low, 0.0))) : std::nullopt;
}

std::optional<double> ErrorParts::abs_bias_high() const {
  return bias2.high ? std::optional(std::sqrt(std::max(*bias2.high, 0.0))) : std::nullopt;
}

std::optional<ErrorParts> separate_errors(std::size_t seeds,
                                          const std::function<RadianceImage(std::size_t)>& image,
                                          const RadianceImage& reference) {
  if (seeds < 2) return std::nullopt;
  const auto count = static_cast<double>(seeds);
  const Moments moments = pixel_moments(seeds, image, reference);
  const auto is_counted = [&](std::size_t i) {  // a seed that is not finite leaves its mark on the mean
    return is_finite(moments.mean[i]) && is_finite(moments.squares[i]) && is_finite(reference.mean[i]);
  };
  Sums all;
  double pixels = 0, noise = 0;
  for (std::size_t i = 0; i < reference.pixels(); ++i) {
    if (!is_counted(i)) continue;
    ++pixels;
    noise += channel_mean(reference.variance[i]);
    all.squared_error += squared_error(moments.mean[i], reference.mean[i]);
    all.variance += channel_mean(moments.squares[i]) / (count - 1);
  }
  if (pixels == 0) return std::nullopt;
  const double bias2 = all.bias2(seeds, pixels, noise);
  std::vector<double> pseudo_values;
  for (std::size_t seed = 0; seed < seeds && seeds > 2; ++seed) {
    const RadianceImage left_out = image(seed);
    Sums rest;
    for (std::size_t i = 0; i < reference.pixels(); ++i) {
      if (!is_counted(i)) continue;
      const glm::dvec3 distance = left_out.mean[i] - moments.mean[i];
      const glm::dvec3 mean = moments.mean[i] - distance / (count - 1);
      const glm::dvec3 squares = moments.squares[i] - distance * distance * (count / (count - 1));
      rest.squared_error += squared_error(mean, reference.mean[i]);
      rest.variance += channel_mean(squares) / (count - 2);
    }
    pseudo_values.push_back(count * bias2 - (count - 1) * rest.bias2(seeds - 1, pixels, noise));
  }
  ErrorParts parts{all.variance / pixels, signed_estimate(pseudo_values).value_or(Estimate{})};
  parts.bias2.mean = bias2;  // equal to the pseudo-values' mean up to rounding
  return parts;
}

}  // namespace qtrace::experiments
