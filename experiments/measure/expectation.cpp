#include "experiments/measure/expectation.h"

#include "engine/core/check.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace qtrace::experiments {
namespace {

struct Area {
  std::string name;
  int x0, y0, x1, y1;  // pixels, the ends excluded
};

struct MeanRadiance {
  double mean = 0;
  double variance = 0;  // of the mean
};

// The whole image, then its blocks; where it is smaller than those, some are empty and left out.
std::vector<Area> areas_of(const RadianceImage& image) {
  std::vector<Area> areas{{"the image", 0, 0, image.width, image.height}};
  for (int i = 0; i < kBlocks * kBlocks; ++i) {
    const int column = i % kBlocks;
    const int row = i / kBlocks;
    const Area block{fmt::format("block ({}, {}) of {} x {}", column, row, kBlocks, kBlocks),
                     image.width * column / kBlocks, image.height * row / kBlocks,
                     image.width * (column + 1) / kBlocks, image.height * (row + 1) / kBlocks};
    if (block.x0 < block.x1 && block.y0 < block.y1) areas.push_back(block);
  }
  return areas;
}

// Pixels are independent of one another; the channels of a pixel share their paths, so that their standard
// deviations add up at worst.
MeanRadiance mean_of(const RadianceImage& image, const Area& area) {
  MeanRadiance sum;
  for (int y = area.y0; y < area.y1; ++y) {
    for (int x = area.x0; x < area.x1; ++x) {
      const auto i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
      const glm::dvec3& m = image.mean[i];
      const glm::dvec3& v = image.variance[i];
      const double deviation = (std::sqrt(v.r) + std::sqrt(v.g) + std::sqrt(v.b)) / 3;
      sum.mean += (m.r + m.g + m.b) / 3;
      sum.variance += deviation * deviation;
    }
  }
  const double n = static_cast<double>(area.x1 - area.x0) * (area.y1 - area.y0);
  return {sum.mean / n, sum.variance / (n * n)};
}

// Difference in standard errors, after what the tolerance allows. NaN counts as infinitely far.
double deviations(const MeanRadiance& a, const MeanRadiance& b, double tolerance) {
  const double excess = std::abs(a.mean - b.mean) - tolerance * std::max(std::abs(a.mean), std::abs(b.mean));
  if (excess <= 0) return 0;
  const double z = excess / std::sqrt(a.variance + b.variance);
  return std::isnan(z) ? std::numeric_limits<double>::infinity() : z;
}

class Judge {
 public:
  Judge(const Expectation& expect, const RadianceImage& image, const RadianceImage& reference)
      : expect_(expect), image_(image), reference_(reference) {}

  Verdict verdict(std::uint64_t non_finite) {
    const std::vector<Area> areas = areas_of(image_);
    const MeanRadiance whole = mean_of(image_, areas[0]);
    verdict_.mean = whole.mean;
    verdict_.mean_error = std::sqrt(whole.variance);
    verdict_.expected = mean_of(reference_, areas[0]).mean;
    if (expect_.against == Against::mean) {
      verdict_.expected = expect_.mean;
      compare(whole, {expect_.mean, 0}, areas[0].name, "the known one");
      // No radiance is negative: chance cannot explain any light at all.
      if (expect_.mean == 0 && whole.mean > 0) {
        verdict_.worst_z = std::numeric_limits<double>::infinity();
        verdict_.reason = fmt::format("the mean of the image is {:.6g} where no light can be", whole.mean);
      }
    }
    for (const Area& area : areas) {
      compare(mean_of(image_, area), mean_of(reference_, area), area.name, "that of the reference");
    }
    if (non_finite > 0) verdict_.reason = fmt::format("{} samples were not finite", non_finite);
    verdict_.word = verdict_.reason.empty() ? "pass" : "fail";
    if (whole.mean == 0 && non_finite == 0 && expect_.black == BlackImage::unseen) {
      // There is light to be seen, or the reference has lost it as well.
      const bool is_lit = mean_of(reference_, areas[0]).mean > 0;
      verdict_.word = is_lit ? "unseen" : "fail";
      verdict_.reason = is_lit ? "" : "the reference is black as well, so that nothing shows the light";
    }
    return verdict_;
  }

 private:
  void compare(const MeanRadiance& found, const MeanRadiance& wanted, const std::string& area,
               const char* truth) {
    const double z = deviations(found, wanted, expect_.tolerance);
    if (z > verdict_.worst_z && z > kMostDeviations) {
      verdict_.reason = fmt::format("the mean of {} is {:.6g} and {} {:.6g}: {:.3g} standard errors", area,
                                    found.mean, truth, wanted.mean, z);
    }
    verdict_.worst_z = std::max(verdict_.worst_z, z);
  }

  const Expectation& expect_;
  const RadianceImage& image_;
  const RadianceImage& reference_;
  Verdict verdict_;
};

}  // namespace

std::optional<Verdict> judge(const Expectation& expect, const RadianceImage& image,
                             const RadianceImage& reference, std::uint64_t non_finite) {
  if (expect.against == Against::nothing) return std::nullopt;
  return Judge(expect, image, reference).verdict(non_finite);
}

}  // namespace qtrace::experiments
