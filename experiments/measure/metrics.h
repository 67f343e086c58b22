// Errors of an image against a reference, in double precision. A pixel's error is the mean over its three
// channels; an image's error is the mean over its pixels.
#pragma once

#include "engine/core/image.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace qtrace::experiments {

constexpr double kEpsilon = 0.01;        // keeps relative errors of dark pixels finite; radiance (squared)
constexpr double kTrimmedShare = 0.001;  // of the pixels, rounded up, at most all but one
constexpr double kFireflyFloor = 0.01;   // of the reference image's mean: darker pixels are taken for it
constexpr double kReferenceFloor = 3.0;  // an error below this times the reference's noise is flagged

// The variance of the reference's own mean, in the norms of mse and relmse.
struct ReferenceNoise {
  double mse = 0;     // mean(var(r))
  double relmse = 0;  // mean(var(r) / (r^2 + epsilon))

  double relative_error() const { return std::sqrt(relmse); }
};

struct ErrorMetrics {
  double mse = 0;
  double relmse = 0;
  double relmse_trimmed = 0;
  double mape = 0;
  double smape = 0;
  double psnr_db = 0;          // infinite for equal images
  std::optional<double> flip;  // nothing where it was not asked for: see flip.h
  double bias = 0;
  std::optional<ReferenceNoise> reference;  // unknown where the reference has fewer than two samples
  std::uint64_t non_finite = 0;  // pixels that are not finite in image or reference: left out above

  // The error against the truth, without bias: image and reference share no samples, so that the reference's
  // variance adds to what is measured. May be negative by chance. Nothing where that variance is unknown.
  std::optional<double> mse_corrected() const;
  std::optional<double> relmse_corrected() const;  // the same to first order in the noise of r

  // Whether the error cannot be told from the reference's noise, in either norm. False if that is unknown.
  bool at_reference_floor() const;
};

// All but flip, which costs more than the rest together. Throws Error where the sizes differ. All errors are
// NaN if no pixel is finite.
ErrorMetrics compare_images(const RadianceImage& image, const RadianceImage& reference);

// Nothing where the reference has fewer than two samples.
std::optional<ReferenceNoise> reference_noise(const RadianceImage& reference);

// Name, formula and source of each metric, for manifests and tables.
struct MetricDefinition {
  std::string name;
  std::string formula;
  std::string source;
};
std::vector<MetricDefinition> metric_definitions();
// Of figures that only runs have: of fireflies, clamping and filtering.
std::vector<MetricDefinition> run_metric_definitions();

}  // namespace qtrace::experiments
