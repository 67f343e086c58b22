#include "experiments/records/curve.h"

#include <algorithm>
#include <cmath>

namespace qtrace::experiments {
namespace {

constexpr std::size_t kFewestPoints = 3;  // of a slope

}  // namespace

Curve curve_of(const RunRecord& record, const Metric& metric) {
  Curve curve;
  for (const SnapshotRecord& snapshot : record.snapshots) {
    const auto error = metric.number(snapshot.errors);
    if (!error) continue;
    curve.push_back({static_cast<double>(snapshot.frame), snapshot.elapsed_s, *error,
                     snapshot.errors.at_reference_floor()});
  }
  return curve;
}

Curve mean_curve(const std::vector<Curve>& curves, std::optional<std::size_t> without) {
  Curve mean;
  const auto count = static_cast<double>(curves.size() - (without ? 1 : 0));
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (i == without) continue;
    mean.resize(curves[i].size());
    for (std::size_t k = 0; k < mean.size(); ++k) {
      const CurvePoint& point = curves[i].at(k);
      mean[k].spp = point.spp;
      mean[k].seconds += point.seconds / count;
      mean[k].error += point.error / count;
      mean[k].at_floor |= point.at_floor;
    }
  }
  return mean;
}

std::optional<double> loglog_slope(const Curve& curve) {
  double count = 0, x_sum = 0, y_sum = 0, xx_sum = 0, xy_sum = 0;
  for (const CurvePoint& point : curve) {
    if (point.at_floor || !(point.error > 0)) continue;
    const double x = std::log(point.spp);
    const double y = std::log(point.error);
    ++count;
    x_sum += x;
    y_sum += y;
    xx_sum += x * x;
    xy_sum += x * y;
  }
  if (count < kFewestPoints) return std::nullopt;
  return (count * xy_sum - x_sum * y_sum) / (count * xx_sum - x_sum * x_sum);
}

std::optional<double> time_to_error(const Curve& curve, double target) {
  const auto reached =
      std::ranges::find_if(curve, [target](const CurvePoint& point) { return point.error <= target; });
  if (reached == curve.begin() || reached == curve.end()) return std::nullopt;
  const CurvePoint& before = *std::prev(reached);
  if (reached->error == target || reached->error == 0) return reached->seconds;
  const double share = std::log(before.error / target) / std::log(before.error / reached->error);
  return before.seconds * std::pow(reached->seconds / before.seconds, share);
}

std::optional<double> error_after(const Curve& curve, double seconds) {
  const auto next =
      std::ranges::find_if(curve, [seconds](const CurvePoint& point) { return point.seconds >= seconds; });
  if (next == curve.end() || !(next->error > 0)) return std::nullopt;
  if (next->seconds == seconds) return next->error;
  if (next == curve.begin() || !(std::prev(next)->error > 0)) return std::nullopt;
  const CurvePoint& before = *std::prev(next);
  const double share = std::log(seconds / before.seconds) / std::log(next->seconds / before.seconds);
  return before.error * std::pow(next->error / before.error, share);
}

}  // namespace qtrace::experiments
