#include "experiments/commands/compare.h"

#include "engine/core/check.h"
#include "experiments/images/exr_picture.h"
#include "experiments/measure/flip.h"
#include "experiments/measure/heat_map.h"
#include "experiments/measure/metrics.h"
#include "experiments/files/text_table.h"

#include <algorithm>

namespace qtrace::experiments {
namespace {

std::string number(double value) { return fmt::format("{:.9g}", value); }

// In the order of metric_definitions().
std::vector<std::string> values(const ErrorMetrics& errors, std::size_t pixels) {
  const std::string unknown = "unknown: the reference has no variance channels";
  const auto known = [&](const std::optional<double>& value) { return value ? number(*value) : unknown; };
  return {number(errors.mse),
          number(errors.relmse),
          number(errors.relmse_trimmed),
          number(errors.mape),
          number(errors.smape),
          number(errors.psnr_db),
          number(*errors.flip),
          number(errors.bias),
          errors.reference ? number(errors.reference->mse) : unknown,
          errors.reference ? number(errors.reference->relmse) : unknown,
          known(errors.mse_corrected()),
          known(errors.relmse_corrected()),
          errors.reference ? (errors.at_reference_floor() ? "yes" : "no") : unknown,
          fmt::format("{} of {} pixels", errors.non_finite, pixels)};
}

std::string metric_table(const ErrorMetrics& errors, std::size_t pixels) {
  const std::vector<MetricDefinition> metrics = metric_definitions();
  const std::vector<std::string> figures = values(errors, pixels);
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < metrics.size(); ++i)
    rows.push_back({metrics[i].name, figures[i], metrics[i].formula});
  return plain_table({"metric", "value", "formula"}, rows);
}

std::string box_text(const PixelBox& box) {
  return fmt::format("pixels {} to {} across, {} to {} down", box.left, box.right, box.top, box.bottom);
}

// What of both files lies at the same place of the frame.
struct Overlap {
  PixelBox image;
  PixelBox reference;
};

PixelBox intersection(const PixelBox& a, const PixelBox& b) {
  return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right),
          std::min(a.bottom, b.bottom)};
}

Overlap overlap(const Picture& image, const Picture& reference, const CompareOptions& options) {
  if (image.display == reference.display) {
    const PixelBox box = intersection(image.data, reference.data);
    check(box.width() > 0 && box.height() > 0, "{}: has {}, but the reference {} has {}: no pixel is in both",
          options.image.string(), box_text(image.data), options.reference.string(), box_text(reference.data));
    return {box, box};
  }
  check(image.data.width() == reference.data.width() && image.data.height() == reference.data.height(),
        "{}: has {}x{} pixels, but the reference {} has {}x{}; both must have the same size",
        options.image.string(), image.data.width(), image.data.height(), options.reference.string(),
        reference.data.width(), reference.data.height());
  return {image.data, reference.data};
}

std::string source_line(const std::string& what, const std::filesystem::path& file, const Picture& picture,
                        const PixelBox& box) {
  std::string line = fmt::format("{} {}: channels {}", what, file.string(), picture.channels);
  if (box != picture.data) line += fmt::format("; {}", box_text(box));
  return line + '\n';
}

std::string draw_heat_map(const CompareOptions& options, const RadianceImage& image,
                          const RadianceImage& reference) {
  const std::vector<double> errors = error_map(options.heat_metric, image, reference);
  const HeatScale scale = heat_scale(options.heat_metric, errors, options.heat_top);
  write_heat_map(options.heat, options.heat_metric, image.width, image.height, errors, scale);
  std::string line =
      fmt::format("\nheat map {}: {} per pixel", options.heat.string(), enum_name(options.heat_metric));
  if (options.heat.extension() == ".png") {
    line += fmt::format(", magma, {} from {:.4g} (black) to {:.4g} (pale yellow); {} of {} pixels are above",
                        scale.bottom > 0 ? "logarithmic" : "linear", scale.bottom, scale.top, scale.above,
                        errors.size());
    if (scale.not_finite > 0) line += fmt::format("; {} are not finite (green)", scale.not_finite);
  }
  return line + '\n';
}

}  // namespace

std::string compare_files(const CompareOptions& options) {
  if (!options.heat.empty()) check_heat_file(options.heat);
  const Picture image = read_picture(options.image, options.layer);
  std::string reference_layer = options.reference_layer;
  if (reference_layer.empty() && !options.layer.empty() && has_layer(options.reference, options.layer)) {
    reference_layer = options.layer;
  }
  const Picture reference = read_picture(options.reference, reference_layer);
  const Overlap same = overlap(image, reference, options);
  const RadianceImage a = crop(image, same.image), r = crop(reference, same.reference);
  ErrorMetrics errors = compare_images(a, r);
  errors.flip = flip_error(a, r);
  std::string text = source_line("image", options.image, image, same.image) +
                     source_line("reference", options.reference, reference, same.reference) + '\n' +
                     metric_table(errors, a.pixels());
  if (!options.heat.empty()) text += draw_heat_map(options, a, r);
  return text;
}

}  // namespace qtrace::experiments
