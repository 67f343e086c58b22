#include "experiments/measure/metrics.h"

#include "engine/core/check.h"
#include "experiments/measure/flip.h"
#include "experiments/measure/ldr_flip.h"
#include "experiments/measure/pixel_errors.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace qtrace::experiments {
namespace {

// NaN for no values at all.
double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// Mean of all but the largest; see kTrimmedShare.
double trimmed_mean(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto share = static_cast<std::size_t>(std::ceil(kTrimmedShare * static_cast<double>(values.size())));
  const std::size_t kept = values.size() - std::min(share, values.size() - 1);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(kept - 1), values.end());
  values.resize(kept);
  return mean(values);
}

}  // namespace

std::optional<double> ErrorMetrics::mse_corrected() const {
  return reference ? std::optional(mse - reference->mse) : std::nullopt;
}

std::optional<double> ErrorMetrics::relmse_corrected() const {
  return reference ? std::optional(relmse - reference->relmse) : std::nullopt;
}

bool ErrorMetrics::at_reference_floor() const {
  return reference &&
         (mse <= kReferenceFloor * reference->mse || relmse <= kReferenceFloor * reference->relmse);
}

ErrorMetrics compare_images(const RadianceImage& image, const RadianceImage& reference) {
  check_same_size(image, reference);
  ErrorMetrics errors;
  std::vector<double> squared, relative, percentage, symmetric, difference;
  double peak = 0;
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    const glm::dvec3 a = image.mean[i];
    const glm::dvec3 r = reference.mean[i];
    if (!is_finite(a) || !is_finite(r)) {
      ++errors.non_finite;
      continue;
    }
    squared.push_back(squared_error(a, r));
    relative.push_back(relative_squared_error(a, r));
    percentage.push_back(absolute_percentage_error(a, r));
    symmetric.push_back(symmetric_percentage_error(a, r));
    difference.push_back(channel_mean(a - r));
    peak = std::max({peak, r.x, r.y, r.z});
  }
  errors.mse = mean(squared);
  errors.relmse = mean(relative);
  errors.relmse_trimmed = trimmed_mean(std::move(relative));
  errors.mape = mean(percentage);
  errors.smape = mean(symmetric);
  errors.psnr_db = 10 * std::log10(peak * peak / errors.mse);
  errors.bias = mean(difference);
  errors.reference = reference_noise(reference);
  return errors;
}

std::optional<ReferenceNoise> reference_noise(const RadianceImage& reference) {
  if (reference.samples < 2) return std::nullopt;
  std::vector<double> absolute, relative;
  for (std::size_t i = 0; i < reference.pixels(); ++i) {
    const glm::dvec3 r = reference.mean[i];
    const glm::dvec3 variance = reference.variance[i];
    if (!is_finite(r) || !is_finite(variance)) continue;
    absolute.push_back(channel_mean(variance));
    relative.push_back(channel_mean(variance / (r * r + kEpsilon)));
  }
  return ReferenceNoise{mean(absolute), mean(relative)};
}

std::vector<MetricDefinition> metric_definitions() {
  const std::string project = "this project";
  return {
      {"mse", "mean((a - r)^2), a: image, r: reference, over pixels and channels", "textbook"},
      {"relmse", fmt::format("mean((a - r)^2 / (r^2 + {}))", kEpsilon),
       "Rousselle, Knaus, Zwicker 2011, Adaptive sampling and reconstruction using greedy error "
       "minimization"},
      {"relmse_trimmed",
       fmt::format("relmse without the {:g} % of pixels (rounded up) with the largest error",
                   kTrimmedShare * 100),
       project},
      {"mape", fmt::format("mean(|a - r| / (|r| + {}))", kEpsilon),
       "Mueller et al. 2019, Neural importance sampling"},
      {"smape", fmt::format("mean(|a - r| / (|a| + |r| + {}))", kEpsilon),
       "Vogels et al. 2018, Denoising with kernel prediction and asymmetric loss functions"},
      {"psnr_db",
       "10 log10(peak^2 / mse), peak: the largest channel value of the reference; inf for equal images",
       "textbook; the peak is this project's, as radiance has none of its own"},
      {"flip",
       fmt::format(
           "mean over pixels of the largest LDR-FLIP over exposures: tone mapper ACES, one exposure a "
           "stop from the reference's brightest to its median luminance at {}, {:.4g} pixels per degree; "
           "in runs only with flip: true",
           kToneAtEnds, kPixelsPerDegree),
       "Andersson, Nilsson, Shirley, Akenine-Moeller 2021, Visualizing errors in rendered high dynamic range "
       "images"},
      {"bias", "mean(a - r)", "textbook"},
      {"reference_mse", "mean(var(r)), var(r): variance of the reference's mean", project},
      {"reference_relmse", fmt::format("mean(var(r) / (r^2 + {}))", kEpsilon), project},
      {"mse_corrected",
       "mse - reference_mse: without bias, as image and reference share no samples (E[mse] = error + "
       "var(r)); "
       "may be negative by chance",
       project},
      {"relmse_corrected",
       "relmse - reference_relmse; to first order in the noise of r, which is in the denominator, too",
       project},
      {"at_reference_floor",
       fmt::format("mse <= {0} * reference_mse or relmse <= {0} * reference_relmse", kReferenceFloor),
       project},
      {"non_finite", "pixels with a NaN or an infinity in image or reference; the means leave them out",
       project},
  };
}

std::vector<MetricDefinition> run_metric_definitions() {
  const std::string project = "this project";
  return {
      {"reference_relative_error", "sqrt(reference_relmse): what reference.relative_error bounds", project},
      {"fireflies",
       fmt::format("samples whose mean over channels exceeds firefly_multiple * max(mean over channels of r, "
                   "{} of the same averaged over all pixels), before clamping",
                   kFireflyFloor),
       project},
      {"firefly_energy_fraction", "radiance of all fireflies / radiance of all samples, before clamping",
       project},
      {"clamp_bias",
       "mean over pixels and channels of the image minus what it would be without clamp_radiance", project},
      {"filtered_*", "the same errors of the image after the filter, which is biased",
       "Dammertz, Sewtz, Hanika, Lensch 2010, Edge-avoiding a-trous wavelet transform for fast global "
       "illumination filtering"},
  };
}

}  // namespace qtrace::experiments
