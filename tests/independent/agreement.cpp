#include "tests/independent/agreement.h"

#include <fmt/format.h>
#include <boost/math/distributions/normal.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace qtrace::independent {
namespace {

constexpr double kNoNoise = 1e-5;  // standard error, relative, below which single precision is what differs

// One channel of a pool of cells.
struct Sum {
  double squares = 0, variances = 0, squared_variances = 0;

  void add(double difference, double variance, double scale) {
    const double rounding = kNoNoise * scale;
    // The same whatever the path, in both images.
    if (variance <= rounding * rounding && std::abs(difference) <= rounding) return;
    squares += difference * difference;
    variances += variance;
    squared_variances += variance * variance;
  }

  bool empty() const { return squares == 0 && variances == 0; }
  double chi2() const { return squares / variances; }
  // Of chi2, for differences that are normally distributed.
  double spread() const { return 2 * squared_variances / (variances * variances); }
};

void add_cell(const Difference& d, int width, int x0, int y0, int cell, std::array<Sum, 3>& sums) {
  glm::dvec3 mean(0), variance(0), scale(0);
  for (int y = y0; y < y0 + cell; ++y) {
    for (int x = x0; x < x0 + cell; ++x) {
      const auto i = static_cast<std::size_t>(y * width + x);
      mean += d.mean[i];
      variance += d.variance[i];
      scale += d.scale[i];
    }
  }
  for (int k = 0; k < 3; ++k) sums[static_cast<std::size_t>(k)].add(mean[k], variance[k], scale[k]);
}

}  // namespace

Chi2 pooled_chi2(const Difference& difference, int cell, int pool) {
  const int width = static_cast<int>(std::lround(std::sqrt(static_cast<double>(difference.mean.size()))));
  const int stride = cell * pool;
  double sum = 0, squares = 0, spread = 0, pools = 0;
  for (int i = 0; i < (width / stride) * (width / stride); ++i) {
    const int x0 = i % (width / stride) * stride;
    const int y0 = i / (width / stride) * stride;
    std::array<Sum, 3> sums;
    for (int k = 0; k < pool * pool; ++k) {
      add_cell(difference, width, x0 + k % pool * cell, y0 + k / pool * cell, cell, sums);
    }
    double chi2 = 0, own_spread = 0, channels = 0;
    for (const Sum& s : sums) {
      if (s.empty()) continue;
      chi2 += s.chi2(), own_spread += s.spread(), ++channels;
    }
    if (channels == 0) continue;
    chi2 /= channels;
    sum += chi2, squares += chi2 * chi2, spread += own_spread / channels, ++pools;
  }
  if (pools == 0) return {};
  const double mean = sum / pools;
  // From the pools' own differences, but no less than chance alone makes it: of few pools, they tell too
  // little.
  return {mean, std::sqrt(std::max(squares / pools - mean * mean, spread / pools) / pools)};
}

bool Agreement::agrees(double chance) const {
  const double z = boost::math::quantile(boost::math::complement(boost::math::normal(), chance / 6));
  const auto is_one = [z](double value, double error) { return std::abs(value - 1) <= z * error; };
  return is_one(pixels.value, pixels.error) && is_one(blocks.value, blocks.error) &&
         is_one(mean_ratio, mean_ratio_error);
}

std::string Agreement::text() const {
  return fmt::format(
      "chi2 per pixel {:.3f} +- {:.3f}, of blocks {:.3f} +- {:.3f}, mean ratio {:.5f} +- {:.5f} after {} "
      "frames",
      pixels.value, pixels.error, blocks.value, blocks.error, mean_ratio, mean_ratio_error, frames);
}

}  // namespace qtrace::independent
