// A convergence curve: errors at growing samples and seconds, and what is read off it.
#pragma once

#include "experiments/records/records.h"

#include <optional>
#include <vector>

namespace qtrace::experiments {

struct CurvePoint {
  double spp = 0;
  double seconds = 0;
  double error = 0;
  bool at_floor = false;  // cannot be told from the reference's noise
};
using Curve = std::vector<CurvePoint>;

// Snapshots at which the metric is unknown are left out.
Curve curve_of(const RunRecord& record, const Metric& metric);

// Arithmetic means of seconds and errors, point by point; a point is at the floor where one of its seeds is.
// The curves must have the same samples. `without`: the index of a curve to leave out.
Curve mean_curve(const std::vector<Curve>& curves, std::optional<std::size_t> without = std::nullopt);

// The exponent b of error = a spp^b: least squares on logarithms over the points above the reference's floor.
// -1 for the MSE of an unbiased estimate with finite variance. Nothing for fewer than three such points.
std::optional<double> loglog_slope(const Curve& curve);

// Seconds until the error first reaches the target: between the last point above it and the first at or below
// it, linearly in the logarithms. Nothing where it is never reached, or already at the first point, before
// which nothing was measured.
std::optional<double> time_to_error(const Curve& curve, double target);

// The error after so many seconds, between two points linearly in the logarithms. Nothing before the first
// point, after the last one, or where one of the two has no positive error.
std::optional<double> error_after(const Curve& curve, double seconds);

}  // namespace qtrace::experiments
