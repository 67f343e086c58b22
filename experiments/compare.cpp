#include "experiments/compare.h"

#include "engine/core/check.h"
#include "experiments/exr.h"
#include "experiments/metrics.h"
#include "experiments/text_table.h"

namespace qtrace::experiments {
namespace {

// In the order of metric_definitions().
std::vector<std::string> values(const ErrorMetrics& errors, std::size_t pixels) {
  const auto number = [](double value) { return fmt::format("{:.9g}", value); };
  const std::string unknown = "unknown: the reference has no variance channels";
  return {number(errors.mse),
          number(errors.relmse),
          number(errors.relmse_trimmed),
          number(errors.mape),
          number(errors.bias),
          errors.reference ? number(errors.reference->mse) : unknown,
          errors.reference ? number(errors.reference->relmse) : unknown,
          errors.reference ? (errors.at_reference_floor() ? "yes" : "no") : unknown,
          fmt::format("{} of {} pixels", errors.non_finite, pixels)};
}

}  // namespace

std::string compare_files(const std::filesystem::path& image_file,
                          const std::filesystem::path& reference_file) {
  const RadianceImage image = to_radiance(read_exr(image_file), image_file);
  const RadianceImage reference = to_radiance(read_exr(reference_file), reference_file);
  check(image.width == reference.width && image.height == reference.height,
        "{}: has {}x{} pixels, but the reference {} has {}x{}; both must have the same size",
        image_file.string(), image.width, image.height, reference_file.string(), reference.width,
        reference.height);
  const std::vector<MetricDefinition> metrics = metric_definitions();
  const std::vector<std::string> figures = values(compare_images(image, reference), image.pixels());
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < metrics.size(); ++i)
    rows.push_back({metrics[i].name, figures[i], metrics[i].formula});
  return plain_table({"metric", "value", "formula"}, rows);
}

}  // namespace qtrace::experiments
