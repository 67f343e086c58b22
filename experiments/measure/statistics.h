// Order statistics and intervals.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace qtrace::experiments {

// The q-quantile, q in [0, 1], between order statistics linearly (Hyndman and Fan's type 7, numpy's default).
// Nothing for no values.
std::optional<double> quantile(std::vector<double> values, double q);

// A mean, the standard deviation of one value (n - 1) and the ends of the mean's 95 % confidence interval.
struct Estimate {
  double mean = 0;
  std::optional<double> sd;  // these three need two values at least
  std::optional<double> low;
  std::optional<double> high;
  std::size_t count = 0;
};

// Of values >= 0 that are skewed upwards, as errors and times are: Student's t interval about the logarithm
// of the mean m, whose standard error is s / (m sqrt(n)) to first order (delta method): m exp(+-t s / (m
// sqrt(n))). The arithmetic mean, since that is what the expected error is; the interval never reaches below
// zero. analysis/statistics.py has the same formula. Nothing for no values.
std::optional<Estimate> estimate(const std::vector<double>& values);

// Of values of either sign: Student's symmetric interval m +- t s / sqrt(n). Nothing for no values.
std::optional<Estimate> signed_estimate(const std::vector<double>& values);

// Student's t with P(|T| < t) = 0.95; degrees > 0 need not be whole.
double t_quantile(double degrees);

}  // namespace qtrace::experiments
