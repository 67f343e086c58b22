#include "experiments/measure/statistics.h"

#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>

namespace qtrace::experiments {
namespace {

constexpr double kConfidence = 0.95;

std::optional<Estimate> moments(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  const auto count = static_cast<double>(values.size());
  Estimate result;
  result.count = values.size();
  for (const double value : values) result.mean += value / count;
  if (values.size() < 2) return result;
  double squares = 0;
  for (const double value : values) squares += (value - result.mean) * (value - result.mean);
  result.sd = std::sqrt(squares / (count - 1));
  return result;
}

double half_width_of(const Estimate& estimate) {
  const auto count = static_cast<double>(estimate.count);
  return t_quantile(count - 1) * *estimate.sd / std::sqrt(count);
}

}  // namespace

double t_quantile(double degrees) {
  return boost::math::quantile(boost::math::students_t(degrees), 0.5 + kConfidence / 2);
}

std::optional<double> quantile(std::vector<double> values, double q) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const double position = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(position));
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], position - std::floor(position));
}

std::optional<Estimate> signed_estimate(const std::vector<double>& values) {
  std::optional<Estimate> result = moments(values);
  if (!result || !result->sd) return result;
  const double half_width = half_width_of(*result);
  result->low = result->mean - half_width;
  result->high = result->mean + half_width;
  return result;
}

std::optional<Estimate> estimate(const std::vector<double>& values) {
  std::optional<Estimate> result = moments(values);
  if (!result || !result->sd) return result;
  const double relative = result->mean == 0 ? 0 : half_width_of(*result) / result->mean;
  result->low = result->mean * std::exp(-relative);
  result->high = result->mean * std::exp(relative);
  return result;
}

}  // namespace qtrace::experiments
