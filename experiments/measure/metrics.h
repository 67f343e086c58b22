// Errors of an image against a reference, in double precision. A pixel's error is the mean over its three
// channels; an image's error is the mean over its pixels.
#pragma once

#include "engine/core/image.h"
#include "experiments/files/csv.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace qtrace::experiments {

constexpr double kTrimmedShare = 0.001;  // of the pixels, rounded up, at most all but one
constexpr double kFireflyFloor = 0.01;   // of the reference image's mean: darker pixels are taken for it
constexpr double kReferenceFloor = 3.0;  // an error below this times the reference's noise is flagged

// The variance of the reference's own mean, in the norms of mse and relmse.
struct ReferenceNoise {
  double mse = 0;     // mean(var(r))
  double relmse = 0;  // mean(var(r) / (r^2 + epsilon))

  double relative_error() const { return std::sqrt(relmse); }
  bool operator==(const ReferenceNoise&) const = default;
};

// What error_metrics() below gives names and formulas to.
struct ErrorMetrics {
  double mse = 0;
  double relmse = 0;
  double relmse_trimmed = 0;
  double mape = 0;
  double smape = 0;
  double psnr_db = 0;          // infinite for equal images
  std::optional<double> flip;  // nothing where it was not asked for: see flip.h
  double bias = 0;
  std::uint64_t non_finite = 0;  // pixels that are not finite in image or reference: left out above
  std::optional<ReferenceNoise> reference;  // unknown where the reference has fewer than two samples

  // The error against the truth, without bias: image and reference share no samples, so that the reference's
  // variance adds to what is measured. May be negative by chance. Nothing where that variance is unknown.
  std::optional<double> mse_corrected() const;
  std::optional<double> relmse_corrected() const;  // the same to first order in the noise of r
  std::optional<double> reference_mse() const;
  std::optional<double> reference_relmse() const;

  // Whether the error cannot be told from the reference's noise, in either norm. False if that is unknown.
  bool at_reference_floor() const;

  bool operator==(const ErrorMetrics&) const = default;
};

// All but flip, which costs more than the rest together. Throws Error where the sizes differ. All errors are
// NaN if no pixel is finite.
ErrorMetrics compare_images(const RadianceImage& image, const RadianceImage& reference);

// Nothing where the reference has fewer than two samples.
std::optional<ReferenceNoise> reference_noise(const RadianceImage& reference);

// How the errors of single pixels are drawn: not at all, on a linear scale from 0, on a logarithmic one, or
// linear from 0 to 1.
enum class HeatScaling { none, linear, logarithmic, to_one };

// Everything about a metric that is not its arithmetic. Columns of CSV files, records, manifests, comparisons
// and heat maps are made from the list of these; Python reads it from the manifests.
struct Metric {
  using Member = std::variant<double ErrorMetrics::*, std::optional<double> ErrorMetrics::*,
                              std::uint64_t ErrorMetrics::*, std::optional<double> (ErrorMetrics::*)() const,
                              bool (ErrorMetrics::*)() const>;
  using Map = std::vector<double> (*)(const RadianceImage& image, const RadianceImage& reference);

  std::string name;   // of its column
  std::string label;  // for people
  std::string unit;   // "" where it has none
  Member member;
  std::string formula;
  std::string source;
  bool is_signed = false;    // may be negative: its interval is symmetric
  bool is_averaged = false;  // over the seeds of a configuration
  bool is_compared = false;  // with a baseline's
  bool is_followed = false;  // over a run's snapshots: slope, and time to the baseline's
  bool is_timed = false;     // compared with the baseline's after the same seconds
  bool is_of_image = true;   // else of the reference alone
  HeatScaling heat = HeatScaling::none;
  Map map = nullptr;  // null where single pixels have no such error

  CsvValue value(const ErrorMetrics& errors) const;                // empty where it is unknown
  std::optional<double> number(const ErrorMetrics& errors) const;  // nothing where it is unknown
};

// In the order of the columns.
const std::vector<Metric>& error_metrics();

// Throws Error where there is none of this name.
const Metric& error_metric(std::string_view name);

}  // namespace qtrace::experiments
