// Statistical tests with fixed seeds. Thresholds come from a stated chance that a true program fails, shared
// out over all comparisons of a test (Bonferroni).
#pragma once

#include "engine/core/image.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace qtrace::test {

// Chance that a correct program fails a test at all.
inline constexpr double kFalseAlarm = 1e-3;

// Two-sided z threshold for `comparisons` comparisons.
inline double z_threshold(std::size_t comparisons) {
  return boost::math::quantile(
      boost::math::complement(boost::math::normal(), kFalseAlarm / (2.0 * static_cast<double>(comparisons))));
}

// Pearson's chi-squared test. Neighbouring counts are pooled until each pool expects at least ten; what is
// left at the end joins the last pool, but nothing may lie where nothing is expected. Returns the probability
// of a worse fit. Throws where there is nothing to compare: one pool fits any counts.
inline double chi_squared_p(const std::vector<double>& observed, const std::vector<double>& expected) {
  if (observed.size() != expected.size()) throw std::invalid_argument("chi_squared_p: sizes differ");
  struct Pool {
    double observed = 0;
    double expected = 0;
  };
  constexpr double kLeastExpected = 10;
  std::vector<Pool> pools;
  Pool open;
  for (std::size_t i = 0; i < observed.size(); ++i) {
    open.observed += observed[i];
    open.expected += expected[i];
    if (open.expected < kLeastExpected) continue;
    pools.push_back(open);
    open = {};
  }
  if (open.expected == 0 && open.observed > 0) return 0;
  if (pools.size() < 2) throw std::invalid_argument("chi_squared_p: the samples fill fewer than two pools");
  pools.back().observed += open.observed;
  pools.back().expected += open.expected;
  double statistic = 0;
  for (const Pool& pool : pools) {
    const double difference = pool.observed - pool.expected;
    statistic += difference * difference / pool.expected;
  }
  const boost::math::chi_squared law(static_cast<double>(pools.size() - 1));
  return boost::math::cdf(boost::math::complement(law, statistic));
}

struct Estimate {
  double mean = 0;
  double variance = 0;  // of the mean
};

// Mean over the channels and pixels of a block; pixels are independent of one another.
inline Estimate block_estimate(const RadianceImage& image, int x0, int y0, int size) {
  Estimate sum;
  for (int y = y0; y < y0 + size; ++y) {
    for (int x = x0; x < x0 + size; ++x) {
      const auto i = static_cast<std::size_t>(y * image.width + x);
      sum.mean += (image.mean[i].r + image.mean[i].g + image.mean[i].b) / 3;
      // Channels of a pixel share their paths: the standard deviations add up at worst.
      const glm::dvec3& v = image.variance[i];
      const double deviation = (std::sqrt(v.r) + std::sqrt(v.g) + std::sqrt(v.b)) / 3;
      sum.variance += deviation * deviation;
    }
  }
  const double n = static_cast<double>(size) * size;
  return {sum.mean / n, sum.variance / (n * n)};
}

// Standard score of the difference of two independent estimates. `rounding` is the part of the larger mean
// that single precision may cost, where an estimate has no variance at all.
inline double z_score(const Estimate& a, const Estimate& b, double rounding = 1e-5) {
  const double slack = rounding * std::max(std::abs(a.mean), std::abs(b.mean));
  const double excess = std::max(0.0, std::abs(a.mean - b.mean) - slack);
  return excess == 0 ? 0 : excess / std::sqrt(std::max(a.variance + b.variance, 1e-300));
}

}  // namespace qtrace::test
