#include "experiments/measure/metrics.h"

#include "engine/core/check.h"
#include "experiments/measure/flip.h"
#include "experiments/measure/ldr_flip.h"
#include "experiments/measure/pixel_errors.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
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

template <PixelError Error>
std::vector<double> map_of(const RadianceImage& image, const RadianceImage& reference) {
  return map_errors(Error, image, reference);
}

CsvValue csv_value(double value) { return value; }
CsvValue csv_value(bool value) { return value; }
CsvValue csv_value(std::uint64_t value) { return value; }
CsvValue csv_value(const std::optional<double>& value) { return maybe(value); }

constexpr const char* kProject = "this project";

std::vector<Metric> errors_of_the_image() {
  using E = ErrorMetrics;
  return {
      {.name = "mse",
       .label = "MSE",
       .unit = "radiance²",
       .member = &E::mse,
       .formula = "mean((a - r)^2), a: image, r: reference, over pixels and channels",
       .source = "textbook",
       .is_averaged = true,
       .is_compared = true,
       .is_followed = true,
       .heat = HeatScaling::logarithmic,
       .map = map_of<squared_error>},
      {.name = "relmse",
       .label = "relMSE",
       .unit = "",
       .member = &E::relmse,
       .formula = fmt::format("mean((a - r)^2 / (r^2 + {}))", kEpsilon),
       .source = "Rousselle, Knaus, Zwicker 2011, Adaptive sampling and reconstruction using greedy error "
                 "minimization",
       .is_averaged = true,
       .is_compared = true,
       .is_followed = true,
       .heat = HeatScaling::logarithmic,
       .map = map_of<relative_squared_error>},
      {.name = "relmse_trimmed",
       .label = "relMSE trimmed",
       .unit = "",
       .member = &E::relmse_trimmed,
       .formula = fmt::format("relmse without the {:g} % of pixels (rounded up) with the largest error",
                              kTrimmedShare * 100),
       .source = kProject,
       .is_averaged = true,
       .is_compared = true},
      {.name = "mape",
       .label = "MAPE",
       .unit = "",
       .member = &E::mape,
       .formula = fmt::format("mean(|a - r| / (|r| + {}))", kEpsilon),
       .source = "Mueller et al. 2019, Neural importance sampling",
       .is_averaged = true,
       .heat = HeatScaling::linear,
       .map = map_of<absolute_percentage_error>},
      {.name = "smape",
       .label = "SMAPE",
       .unit = "",
       .member = &E::smape,
       .formula = fmt::format("mean(|a - r| / (|a| + |r| + {}))", kEpsilon),
       .source = "Vogels et al. 2018, Denoising with kernel prediction and asymmetric loss functions",
       .is_averaged = true,
       .heat = HeatScaling::linear,
       .map = map_of<symmetric_percentage_error>},
      {.name = "psnr_db",
       .label = "PSNR",
       .unit = "dB",
       .member = &E::psnr_db,
       .formula = "10 log10(peak^2 / mse), peak: the largest channel value of the reference; inf for equal "
                  "images",
       .source = "textbook; the peak is this project's, as radiance has none of its own",
       .is_signed = true,
       .is_averaged = true},
      {.name = "flip",
       .label = "FLIP",
       .unit = "",
       .member = &E::flip,
       .formula = fmt::format(
           "mean over pixels of the largest LDR-FLIP over exposures: tone mapper ACES, one exposure a "
           "stop from the reference's brightest to its median luminance at {}, {:.4g} pixels per degree; "
           "in runs only with flip: true",
           kToneAtEnds, kPixelsPerDegree),
       .source = "Andersson, Nilsson, Shirley, Akenine-Moeller 2021, Visualizing errors in rendered high "
                 "dynamic range images",
       .is_averaged = true,
       .heat = HeatScaling::to_one,
       .map = flip_map},
      {.name = "bias",
       .label = "bias",
       .unit = "radiance",
       .member = &E::bias,
       .formula = "mean(a - r)",
       .source = "textbook",
       .is_signed = true,
       .is_averaged = true},
  };
}

std::vector<Metric> errors_beside_the_reference_noise() {
  using E = ErrorMetrics;
  return {
      {.name = "mse_corrected",
       .label = "MSE corrected",
       .unit = "radiance²",
       .member = &E::mse_corrected,
       .formula = "mse - reference_mse: without bias, as image and reference share no samples (E[mse] = "
                  "error + var(r)); may be negative by chance",
       .source = kProject,
       .is_signed = true,
       .is_averaged = true,
       .is_timed = true},
      {.name = "relmse_corrected",
       .label = "relMSE corrected",
       .unit = "",
       .member = &E::relmse_corrected,
       .formula = "relmse - reference_relmse; to first order in the noise of r, which is in the "
                  "denominator, too",
       .source = kProject,
       .is_signed = true,
       .is_averaged = true,
       .is_timed = true},
      {.name = "at_reference_floor",
       .label = "at floor",
       .unit = "",
       .member = &E::at_reference_floor,
       .formula =
           fmt::format("mse <= {0} * reference_mse or relmse <= {0} * reference_relmse", kReferenceFloor),
       .source = kProject},
      {.name = "non_finite_pixels",
       .label = "non-finite pixels",
       .unit = "pixels",
       .member = &E::non_finite,
       .formula = "pixels with a NaN or an infinity in image or reference; the means leave them out",
       .source = kProject},
      {.name = "reference_mse",
       .label = "reference MSE",
       .unit = "radiance²",
       .member = &E::reference_mse,
       .formula = "mean(var(r)), var(r): variance of the reference's mean",
       .source = kProject,
       .is_of_image = false},
      {.name = "reference_relmse",
       .label = "reference relMSE",
       .unit = "",
       .member = &E::reference_relmse,
       .formula = fmt::format("mean(var(r) / (r^2 + {}))", kEpsilon),
       .source = kProject,
       .is_of_image = false},
  };
}

}  // namespace

CsvValue Metric::value(const ErrorMetrics& errors) const {
  return std::visit([&](const auto& of) { return csv_value(std::invoke(of, errors)); }, member);
}

std::optional<double> Metric::number(const ErrorMetrics& errors) const {
  const CsvValue found = value(errors);
  const double* number = std::get_if<double>(&found);
  return number == nullptr ? std::nullopt : std::optional(*number);
}

const std::vector<Metric>& error_metrics() {
  static const std::vector<Metric> all = [] {
    std::vector<Metric> metrics = errors_of_the_image();
    std::ranges::move(errors_beside_the_reference_noise(), std::back_inserter(metrics));
    return metrics;
  }();
  return all;
}

const Metric& error_metric(std::string_view name) {
  const auto found = std::ranges::find(error_metrics(), name, &Metric::name);
  check(found != error_metrics().end(), "there is no metric '{}'", name);
  return *found;
}

std::optional<double> ErrorMetrics::mse_corrected() const {
  return reference ? std::optional(mse - reference->mse) : std::nullopt;
}

std::optional<double> ErrorMetrics::relmse_corrected() const {
  return reference ? std::optional(relmse - reference->relmse) : std::nullopt;
}

std::optional<double> ErrorMetrics::reference_mse() const {
  return reference ? std::optional(reference->mse) : std::nullopt;
}

std::optional<double> ErrorMetrics::reference_relmse() const {
  return reference ? std::optional(reference->relmse) : std::nullopt;
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

}  // namespace qtrace::experiments
