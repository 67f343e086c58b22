#include "tests/bench/rays.h"

#include "engine/gpu/structs.h"
#include "tests/bench/embree.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <random>

namespace qtrace::bench {
namespace {

constexpr std::uint32_t kSeed = 20200917;
constexpr int kTile = 8;

// The same numbers with every standard library, unlike std::uniform_real_distribution.
class Units {
 public:
  float next() { return static_cast<float>(bits_() >> 8U) * (1.0F / 16777216.0F); }

 private:
  std::mt19937 bits_{kSeed};
};

struct SurfacePoint {
  glm::vec3 position;
  glm::vec3 normal;
};

// Points by area on some of a scene's triangles.
class SurfacePoints {
 public:
  explicit SurfacePoints(const Scene& scene) : scene_(scene) {
    const auto emits = [&](const Triangle& t) {
      return scene.materials[t.material].emission != glm::vec3(0);
    };
    const bool has_light = std::ranges::any_of(scene.triangles, emits);
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
      if (has_light && !emits(scene.triangles[i])) continue;
      triangles_.push_back(i);
      area_ += area_of(scene.triangles[i]);
      areas_.push_back(area_);
    }
  }

  SurfacePoint next(Units& units) const {
    const auto place = std::ranges::upper_bound(areas_, area_ * static_cast<double>(units.next()));
    const auto index = std::min<std::ptrdiff_t>(place - areas_.begin(), std::ssize(areas_) - 1);
    const auto& p = scene_.triangles[triangles_[static_cast<std::size_t>(index)]].position;
    const float root = std::sqrt(units.next());
    const float along = units.next();
    return {p[0] + root * (1 - along) * (p[1] - p[0]) + root * along * (p[2] - p[0]),
            glm::vec3(glm::normalize(area_vector(p)))};
  }

 private:
  const Scene& scene_;
  std::vector<std::uint32_t> triangles_;
  std::vector<double> areas_;  // running sum
  double area_ = 0;
};

std::vector<BenchRay> primary_rays(const Camera& camera, int size, Units& units) {
  std::vector<BenchRay> rays;
  const glm::mat4& m = camera.world_from_camera;
  const float up = std::tan(camera.vertical_fov / 2);
  const auto add = [&](int x, int y) {
    const float right = 2 * (static_cast<float>(x) + units.next()) / static_cast<float>(size) - 1;
    const float above = 1 - 2 * (static_cast<float>(y) + units.next()) / static_cast<float>(size);
    const glm::vec3 direction = -m[2] + up * right * m[0] + up * above * m[1];
    rays.push_back({m[3], glm::vec4(glm::normalize(direction), 0)});
  };
  const int tiles = (size + kTile - 1) / kTile;
  for (int tile = 0; tile < tiles * tiles; ++tile) {
    for (int lane = 0; lane < kTile * kTile; ++lane) {
      // pixel_of_invocation() of camera.glsl: 4 x 2 pixels are neighbouring lanes.
      const int x = tile % tiles * kTile + (lane >> 3 & 1) * 4 + (lane & 3);
      const int y = tile / tiles * kTile + (lane >> 4) * 2 + (lane >> 2 & 1);
      if (x < size && y < size) add(x, y);
    }
  }
  return rays;
}

glm::vec3 cosine_direction(glm::vec3 normal, Units& units) {
  const float z = 1 - 2 * units.next();
  const float phi = 2 * std::numbers::pi_v<float> * units.next();
  const float sine = std::sqrt(std::max(0.0F, 1 - z * z));
  // A point on the unit sphere about the normal's end is one by cosine on the hemisphere, seen from its foot.
  const glm::vec3 sum = normal + glm::vec3(sine * std::cos(phi), sine * std::sin(phi), z);
  return glm::dot(sum, sum) > 1e-8F ? glm::normalize(sum) : normal;
}

// Off the surface, as the tracer leaves it: in units in the last place of the largest coordinate.
glm::vec3 off_surface(glm::vec3 point, glm::vec3 normal) {
  const float size = std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
  return point + 4 * gpu::OFFSET_FRACTION * size * normal;
}

// From the light, as the tracer's, whose neighbours share more of their way so; none where the surface does
// not face the light, or where the light is seen edge on.
std::optional<BenchRay> shadow_ray(const SurfacePoint& light, glm::vec3 surface, glm::vec3 normal) {
  constexpr float kEdgeOn = 1e-3F;  // cosine
  const glm::vec3 way = surface - light.position;
  if (glm::dot(normal, way) >= 0 || std::abs(glm::dot(light.normal, way)) < kEdgeOn * glm::length(way))
    return {};
  // A thousandth of the way off, where the light must not hide itself.
  constexpr float kStart = 0.001F;
  const glm::vec3 start = glm::mix(light.position, surface, kStart);
  return BenchRay{glm::vec4(start, 0), glm::vec4(surface - start, 0)};
}

// Spreads the lowest ten bits of a number over every third place.
std::uint32_t spread_bits(std::uint32_t v) {
  v = (v | v << 16) & 0x030000ffU;
  v = (v | v << 8) & 0x0300f00fU;
  v = (v | v << 4) & 0x030c30c3U;
  return (v | v << 2) & 0x09249249U;
}

}  // namespace

RaySets make_rays(const Scene& scene, const EmbreeScene& embree, int size) {
  Units units;
  const SurfacePoints points(scene);
  RaySets rays;
  rays.primary = primary_rays(scene.camera, size, units);
  std::vector<Answer> hits;
  embree.closest_hits(rays.primary, hits);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].triangle == RTC_INVALID_GEOMETRY_ID) continue;
    const glm::vec3 direction(rays.primary[i].direction);
    glm::vec3 normal(glm::normalize(area_vector(scene.triangles[hits[i].triangle].position)));
    if (glm::dot(normal, direction) > 0) normal = -normal;
    const glm::vec3 hit = glm::vec3(rays.primary[i].origin) + hits[i].t * direction;
    const glm::vec3 origin = off_surface(hit, normal);
    rays.bounce.push_back({glm::vec4(origin, 0), glm::vec4(cosine_direction(normal, units), 0)});
    if (const auto ray = shadow_ray(points.next(units), origin, normal)) rays.shadow.push_back(*ray);
  }
  return rays;
}

std::vector<BenchRay> sorted_rays(const std::vector<BenchRay>& rays) {
  constexpr float kSteps = 1023;
  glm::vec3 lo(std::numeric_limits<float>::infinity());
  glm::vec3 hi = -lo;
  for (const BenchRay& ray : rays) {
    lo = glm::min(lo, glm::vec3(ray.origin));
    hi = glm::max(hi, glm::vec3(ray.origin));
  }
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  for (const BenchRay& ray : rays) {
    const glm::uvec3 place(kSteps * (glm::vec3(ray.origin) - lo) / glm::max(hi - lo, glm::vec3(1e-20F)));
    const std::uint64_t octant =
        (ray.direction.x < 0 ? 1U : 0U) | (ray.direction.y < 0 ? 2U : 0U) | (ray.direction.z < 0 ? 4U : 0U);
    const std::uint32_t along = spread_bits(place.x) | spread_bits(place.y) << 1 | spread_bits(place.z) << 2;
    order.emplace_back(octant << 32 | along, order.size());
  }
  std::ranges::sort(order);
  std::vector<BenchRay> sorted;
  for (const auto& [key, index] : order) sorted.push_back(rays[index]);
  return sorted;
}

}  // namespace qtrace::bench
