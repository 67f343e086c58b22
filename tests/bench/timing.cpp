#include "tests/bench/timing.h"

#include "experiments/measure/statistics.h"

#include <fmt/format.h>

namespace qtrace::bench {
namespace {

constexpr double kLowerQuartile = 0.25;
constexpr double kUpperQuartile = 0.75;

}  // namespace

Spread spread_of(const std::vector<double>& values) {
  using experiments::quantile;
  return {quantile(values, 0.5).value_or(0), quantile(values, kLowerQuartile).value_or(0),
          quantile(values, kUpperQuartile).value_or(0)};
}

Spread operator*(double scale, const Spread& spread) {
  return {scale * spread.median, scale * spread.low, scale * spread.high};
}

std::string text_of(const Spread& spread) {
  return fmt::format("{:.3g} [{:.3g}, {:.3g}]", spread.median, spread.low, spread.high);
}

Spread rate_of(double amount, const std::vector<double>& seconds) {
  std::vector<double> rates;
  for (const double s : seconds) rates.push_back(amount / s);
  return spread_of(rates);
}

Spread ratio_of(const std::vector<double>& numerators, const std::vector<double>& denominators) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < numerators.size(); ++i) ratios.push_back(numerators[i] / denominators[i]);
  return spread_of(ratios);
}

}  // namespace qtrace::bench
