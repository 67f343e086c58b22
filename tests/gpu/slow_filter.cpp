#include "tests/gpu/slow_filter.h"

#include "engine/tracer/atrous.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace qtrace::test {
namespace {

class SlowFilter {
 public:
  SlowFilter(const FirstHitImage& hits, const FilterSettings& settings) : hits_(hits), settings_(settings) {
    double count = 0;
    glm::dvec3 sum(0);
    glm::dvec3 squares(0);
    for (std::size_t i = 0; i < hits.normal.size(); ++i) {
      if (hits.normal[i] == glm::vec3(0)) continue;
      const glm::dvec3 p(hits.position[i]);
      sum += p;
      squares += p * p;
      ++count;
    }
    const glm::dvec3 variance = squares / count - sum / count * sum / count;
    view_size_ = std::sqrt(variance.x + variance.y + variance.z);
  }

  std::vector<glm::dvec3> apply(const RadianceImage& image) const {
    std::vector<glm::dvec3> level(image.pixels());
    double sum = 0;
    double count = 0;
    for (std::size_t i = 0; i < level.size(); ++i) {
      if (!takes_part(image, i)) continue;
      for (int c = 0; c < 3; ++c) {
        level[i][c] = image.mean[i][c] / divisor(i, c);
        sum += level[i][c];
        ++count;
      }
    }
    for (int pass = 0; pass < settings_.iterations; ++pass) level = one_pass(image, level, pass, sum / count);
    std::vector<glm::dvec3> result = image.mean;
    for (std::size_t i = 0; i < level.size(); ++i) {
      for (int c = 0; c < 3 && takes_part(image, i); ++c) result[i][c] = level[i][c] * divisor(i, c);
    }
    return result;
  }

 private:
  bool takes_part(const RadianceImage& image, std::size_t i) const {
    const glm::dvec3& v = image.mean[i];
    return hits_.normal[i] != glm::vec3(0) && hits_.emission[i] == glm::vec3(0) &&
           std::isfinite(v.x + v.y + v.z);
  }

  bool divided(std::size_t i, int c) const { return hits_.albedo[i][c] >= AtrousFilter::kLeastAlbedo; }
  double divisor(std::size_t i, int c) const { return divided(i, c) ? double{hits_.albedo[i][c]} : 1.0; }

  static double squared(const glm::dvec3& v, double sigma) { return glm::dot(v, v) / (sigma * sigma); }

  std::vector<glm::dvec3> one_pass(const RadianceImage& image, const std::vector<glm::dvec3>& level, int pass,
                                   double mean) const {
    const double spline[5] = {1 / 16.0, 1 / 4.0, 3 / 8.0, 1 / 4.0, 1 / 16.0};
    std::vector<glm::dvec3> result = level;
    for (int at = 0; at < static_cast<int>(level.size()); ++at) {
      const auto p = static_cast<std::size_t>(at);
      glm::dvec3 sum(0);
      glm::dvec3 weights(0);
      for (int tap = 0; tap < 25 && takes_part(image, p); ++tap) {
        const int x = at % image.width + (tap % 5 - 2) * (1 << pass);
        const int y = at / image.width + (tap / 5 - 2) * (1 << pass);
        if (x < 0 || y < 0 || x >= image.width || y >= image.height) continue;
        const auto q = static_cast<std::size_t>(y * image.width + x);
        if (!takes_part(image, q)) continue;
        glm::dvec3 difference(0);
        for (int c = 0; c < 3; ++c) {
          if (divided(p, c) == divided(q, c)) difference[c] = level[p][c] - level[q][c];
        }
        const double exponent =
            squared(difference, settings_.sigma_radiance * mean / (1 << pass)) +
            squared(glm::dvec3(hits_.normal[p] - hits_.normal[q]), settings_.sigma_normal) +
            squared(glm::dvec3(hits_.position[p]) - glm::dvec3(hits_.position[q]),
                    settings_.sigma_position * view_size_);
        const double weight = spline[tap % 5] * spline[tap / 5] * std::exp(-exponent);
        for (int c = 0; c < 3; ++c) {
          if (divided(p, c) != divided(q, c)) continue;
          sum[c] += weight * level[q][c];
          weights[c] += weight;
        }
      }
      if (takes_part(image, p)) result[p] = sum / weights;
    }
    return result;
  }

  const FirstHitImage& hits_;
  const FilterSettings& settings_;
  double view_size_ = 0;
};

}  // namespace

std::vector<glm::dvec3> slow_atrous(const FirstHitImage& hits, const RadianceImage& image,
                                    const FilterSettings& settings) {
  return SlowFilter(hits, settings).apply(image);
}

}  // namespace qtrace::test
