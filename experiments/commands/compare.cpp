#include "experiments/commands/compare.h"

#include "engine/core/check.h"
#include "experiments/files/text_table.h"
#include "experiments/images/exr_layers.h"
#include "experiments/images/exr_picture.h"
#include "experiments/measure/flip.h"
#include "experiments/measure/heat_map.h"
#include "experiments/measure/metrics.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

namespace qtrace::experiments {
namespace {

std::string number(double value) { return fmt::format("{:.9g}", value); }

std::string text_of(const Metric& metric, const ErrorMetrics& errors, std::size_t pixels) {
  const CsvValue value = metric.value(errors);
  if (metric.name == "non_finite_pixels") return fmt::format("{} of {} pixels", errors.non_finite, pixels);
  if (const bool* flag = std::get_if<bool>(&value); flag != nullptr && errors.reference)
    return *flag ? "yes" : "no";
  const auto known = metric.number(errors);
  return known ? number(*known) : "unknown: the reference has no variance channels";
}

std::string metric_table(const ErrorMetrics& errors, std::size_t pixels) {
  std::vector<std::vector<std::string>> rows;
  for (const Metric& metric : error_metrics()) {
    rows.push_back({metric.name, text_of(metric, errors, pixels), metric.formula});
  }
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
  const Metric& metric = error_metric(options.heat_metric);
  const std::vector<double> errors = metric.map(image, reference);
  const HeatScale scale = heat_scale(metric.heat, errors, options.heat_top);
  write_heat_map(options.heat, metric, image.width, image.height, errors, scale);
  std::string line = fmt::format("\nheat map {}: {} per pixel", options.heat.string(), metric.name);
  if (options.heat.extension() == ".png") {
    line += fmt::format(", magma, {} from {:.4g} (black) to {:.4g} (pale yellow); {} of {} pixels are above",
                        scale.bottom > 0 ? "logarithmic" : "linear", scale.bottom, scale.top, scale.above,
                        errors.size());
    if (scale.not_finite > 0) line += fmt::format("; {} are not finite (green)", scale.not_finite);
  }
  return line + '\n';
}

// Where no layer of its own is named, that of the image.
Picture read_reference(const CompareOptions& options) {
  if (!options.reference_layer.empty()) return read_picture(options.reference, options.reference_layer);
  check(options.layer.empty() || has_layer(options.reference, options.layer),
        "{}: has no layer '{}', which {} has; --reference-layer names the one to compare with ('{}': its "
        "channels outside any layer)",
        options.reference.string(), options.layer, options.image.string(), kRootLayer);
  return read_picture(options.reference, options.layer);
}

std::size_t non_finite_pixels(const RadianceImage& image) {
  return static_cast<std::size_t>(std::ranges::count_if(
      image.mean, [](const glm::dvec3& pixel) { return !std::isfinite(pixel.r + pixel.g + pixel.b); }));
}

// What the metrics leave out, before any of them; Error where that is everything.
std::string non_finite_line(const ErrorMetrics& errors, const RadianceImage& image,
                            const RadianceImage& reference, const CompareOptions& options) {
  if (errors.non_finite == 0) return "";
  const std::size_t of_image = non_finite_pixels(image), of_reference = non_finite_pixels(reference);
  check(errors.non_finite < image.pixels(),
        "{}: no pixel is finite both there ({} of {} are not) and in the reference {} ({}), so that nothing "
        "can be compared",
        options.image.string(), of_image, image.pixels(), options.reference.string(), of_reference);
  return fmt::format(
      "left out: {} of {} pixels, which are not finite ({} in the image, {} in the reference)\n",
      errors.non_finite, image.pixels(), of_image, of_reference);
}

}  // namespace

std::string compare_files(const CompareOptions& options) {
  if (!options.heat.empty()) check_heat_file(options.heat);
  const Picture image = read_picture(options.image, options.layer);
  const Picture reference = read_reference(options);
  const Overlap same = overlap(image, reference, options);
  const RadianceImage a = crop(image, same.image), r = crop(reference, same.reference);
  ErrorMetrics errors = compare_images(a, r);
  const std::string left_out = non_finite_line(errors, a, r, options);
  errors.flip = flip_error(a, r);
  std::string text = source_line("image", options.image, image, same.image) +
                     source_line("reference", options.reference, reference, same.reference) + left_out +
                     '\n' + metric_table(errors, a.pixels());
  if (!options.heat.empty()) text += draw_heat_map(options, a, r);
  return text;
}

void add_compare_command(CLI::App& app, Action& action) {
  const auto kept = std::make_shared<CompareOptions>();
  CompareOptions& options = *kept;
  CLI::App* compare = app.add_subcommand("compare", "Error metrics of an image against a reference");
  compare->add_option("IMAGE", options.image, "OpenEXR file: R, G, B, a layer of them, X, Y, Z or Y")
      ->required();
  compare->add_option("REFERENCE", options.reference, "the same, perhaps with variances")->required();
  compare->add_option("--layer", options.layer, "the layer or part to compare, where there are several");
  compare->add_option("--reference-layer", options.reference_layer, "of the reference (default: --layer)");
  compare->add_option("--heat", options.heat,
                      "writes the error of every pixel: .png in false colours, .exr the values");
  std::vector<std::string> names;
  for (const Metric& metric : error_metrics()) {
    if (metric.map != nullptr) names.push_back(metric.name);
  }
  compare->add_option("--heat-metric", options.heat_metric, "default: relmse")->check(CLI::IsMember(names));
  compare
      ->add_option("--heat-max", options.heat_top,
                   "error with the brightest colour (default: flip 1, else the 99th percentile)")
      ->check(CLI::PositiveNumber);
  compare->callback([&action, kept] {
    action = [kept] {
      fmt::print("{}", compare_files(*kept));
      return 0;
    };
  });
}

}  // namespace qtrace::experiments
