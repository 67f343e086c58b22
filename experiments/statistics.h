// Order statistics and intervals.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace qtrace::experiments {

// The q-quantile, q in [0, 1], between order statistics linearly (Hyndman and Fan's type 7, numpy's default).
// Nothing for no values.
std::optional<double> quantile(std::vector<double> values, double q);

// A mean with the half width of its 95 % confidence interval by Student's t distribution.
struct Estimate {
  double mean = 0;
  std::optional<double> half_width;  // needs two values at least
  std::size_t count = 0;
};

// Nothing for no values.
std::optional<Estimate> estimate(const std::vector<double>& values);

}  // namespace qtrace::experiments
