#include "experiments/records/fireflies.h"

#include "experiments/measure/metrics.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace qtrace::experiments {
namespace {

constexpr std::size_t kMostListed = 64;

double brightness(const glm::dvec3& v) { return (v.x + v.y + v.z) / 3; }

double mean_brightness(const RadianceImage& image) {
  const double sum =
      std::accumulate(image.mean.begin(), image.mean.end(), 0.0,
                      [](double before, const glm::dvec3& pixel) { return before + brightness(pixel); });
  return sum / static_cast<double>(image.pixels());
}

double sample_count(const RadianceImage& image) {
  return static_cast<double>(image.samples) * static_cast<double>(image.pixels());
}

// What a sample of each pixel is measured by.
std::vector<double> expected_brightness(const RadianceImage& reference) {
  const double least = kFireflyFloor * mean_brightness(reference);
  std::vector<double> expected;
  for (const glm::dvec3& pixel : reference.mean) expected.push_back(std::max(brightness(pixel), least));
  return expected;
}

}  // namespace

std::vector<float> firefly_thresholds(const RadianceImage& reference, double multiple) {
  constexpr double kMost = std::numeric_limits<float>::max();
  std::vector<float> thresholds;
  for (const double expected : expected_brightness(reference)) {
    thresholds.push_back(static_cast<float>(std::min(multiple * expected, kMost)));
  }
  return thresholds;
}

double clamp_bias(const Outliers& outliers, const RadianceImage& image) {
  return 0 - outliers.clamped_away / sample_count(image);
}

FireflyRecord firefly_record(const Outliers& outliers, const RadianceImage& image) {
  FireflyRecord record;
  const double all = mean_brightness(image) * sample_count(image) + outliers.clamped_away;
  if (all > 0) record.energy_fraction = outliers.firefly_sum / all;
  if (!outliers.brightest.empty()) record.brightest = outliers.brightest.front().radiance;
  return record;
}

Json brightest_fireflies(const Outliers& outliers, const RadianceImage& reference) {
  const std::vector<double> expected = expected_brightness(reference);
  Json list = Json::array();
  for (const Firefly& firefly : outliers.brightest) {
    if (list.size() == kMostListed) break;
    const auto pixel = firefly.y * static_cast<std::size_t>(reference.width) + firefly.x;
    list.push_back({{"x", firefly.x},
                    {"y", firefly.y},
                    {"frame", firefly.frame},
                    {"radiance", firefly.radiance},
                    {"multiple", firefly.radiance / expected[pixel]}});
  }
  return list;
}

}  // namespace qtrace::experiments
