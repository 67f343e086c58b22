#include "tests/independent/path_tracer.h"

#include "tests/independent/bvh.h"
#include "tests/independent/camera.h"
#include "tests/independent/environment.h"
#include "tests/independent/lights.h"
#include "tests/independent/random.h"
#include "tests/independent/scattering.h"
#include "tests/independent/surface.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <optional>
#include <thread>

namespace qtrace::independent {
namespace {

constexpr int kLattice = 17;  // rays each way in which a pixel is searched for a light's edge
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Radiance towards the eye. A clearcoat lies over what emits as well (KHR_materials_clearcoat).
glm::dvec3 emitted(const Point& p) {
  if (p.material->is_unlit) return p.surface.base_color;
  if (!p.from_front && !p.material->double_sided) return glm::dvec3(0);
  return (1 - coat_share(p)) * p.surface.emission;
}

// What a distance within the volume of a material leaves; no material: all (KHR_materials_volume).
glm::dvec3 transmittance(const Material* medium, double distance) {
  if (!medium || medium->attenuation_distance == std::numeric_limits<float>::infinity()) return glm::dvec3(1);
  return glm::pow(glm::dvec3(medium->attenuation_color), glm::dvec3(distance / medium->attenuation_distance));
}

// Where a path is on from a point in this direction.
const Material* medium_beyond(const Point& p, const glm::dvec3& direction, const Material* medium) {
  if (glm::dot(p.face, direction) > 0 || p.material->is_thin) return medium;
  return p.from_front ? p.material : nullptr;
}

class Tracer {
 public:
  Tracer(const Scene& scene, const Options& options)
      : scene_(scene), options_(options), bvh_(scene), area_lights_(scene) {
    if (scene.environment) environment_.emplace(*scene.environment);
    glm::dvec3 lo(1e300), hi(-1e300);
    for (const Triangle& triangle : scene.triangles) {
      for (const glm::vec3& p : triangle.position)
        lo = glm::min(lo, glm::dvec3(p)), hi = glm::max(hi, glm::dvec3(p));
    }
    if (!scene.triangles.empty()) epsilon_ = 1e-9 * glm::length(hi - lo);
  }

  bool sees_edge_of_light(int x, int y) const {
    const std::optional<glm::dvec3> corner = light_seen(ray_at(x, y));
    for (int k = 1; k < kLattice * kLattice; ++k) {
      const double dx = k % kLattice, dy = k / kLattice;
      if (light_seen(ray_at(x + dx / (kLattice - 1), y + dy / (kLattice - 1))) != corner) return true;
    }
    return false;
  }

  glm::dvec3 sample(int x, int y, Random& random) const {
    Ray ray = ray_at(x + random(), y + random());
    const Material* medium = nullptr;  // the camera is outside
    glm::dvec3 radiance(0), throughput(1);
    double drawn_by = kInfinity;  // density of the ray's direction; infinite where no light sample has it
    for (int bounce = 0;; ++bounce) {
      const Hit hit = seen(ray, random);
      throughput *= transmittance(medium, hit.t);
      if (!hit) return radiance + throughput * from_outside(ray.direction, drawn_by);
      const Point p = point_at(scene_, hit, ray.origin + hit.t * ray.direction, -ray.direction);
      radiance += throughput * emitted(p) * share_of_path(ray, hit, p, drawn_by);
      if (bounce == options_.max_bounces || p.material->is_unlit) return radiance;
      const Scattering scattering(p);
      if (options_.sample_lights) radiance += throughput * direct(p, scattering, medium, random);
      const Scattering::Sample next = scattering.sample(random);
      throughput *= next.weight;
      if (throughput == glm::dvec3(0)) return radiance;
      drawn_by = next.density;
      medium = medium_beyond(p, next.direction, medium);
      ray = {p.position, next.direction};
    }
  }

 private:
  Ray ray_at(double x, double y) const {
    return camera_ray(scene_.camera, x, y, options_.width, options_.height);
  }

  // The nearest surface that the ray does not pass.
  Hit seen(const Ray& ray, Random& random) const {
    Hit hit = bvh_.closest(ray, epsilon_);
    while (hit) {
      const double chance = chance_to_stop(scene_, hit);
      if (chance == 1 || (chance > 0 && random() < chance)) break;
      hit = bvh_.closest(ray, hit.t);
    }
    return hit;
  }

  // The part of the light that passes all surfaces there; the direction need not be unit.
  double passing(const Ray& ray, double t_min, double t_max) const {
    double part = 1;
    for (Hit hit = bvh_.closest(ray, t_min, t_max); hit && part > 0; hit = bvh_.closest(ray, hit.t, t_max)) {
      part *= 1 - chance_to_stop(scene_, hit);
    }
    return part;
  }

  // What tells lights apart in the picture, whatever their textures; none: an image of the sky.
  std::optional<glm::dvec3> light_seen(const Ray& ray) const {
    Hit hit = bvh_.closest(ray, epsilon_);
    while (hit && chance_to_stop(scene_, hit) == 0) hit = bvh_.closest(ray, hit.t);
    if (!hit && environment_) return {};
    if (!hit) return options_.environment;
    const Triangle& t = scene_.triangles[hit.triangle];
    const Material& m = scene_.materials[t.material];
    if (m.is_unlit) return glm::dvec3(m.base_color);
    const bool from_front = glm::dot(area_vector(t.position), ray.direction) < 0;
    return from_front || m.double_sided ? glm::dvec3(m.emission) : glm::dvec3(0);
  }

  // By the balance heuristic (Veach & Guibas 1995).
  double share_of_path(const Ray& ray, const Hit& hit, const Point& p, double drawn_by) const {
    if (!options_.sample_lights || drawn_by == kInfinity || p.material->is_unlit || area_lights_.empty())
      return 1;
    const double by_light =
        area_lights_.density(ray.origin, hit.triangle) * hit.t * hit.t / glm::dot(p.face, p.eye);
    return drawn_by / (drawn_by + by_light);
  }

  glm::dvec3 from_outside(const glm::dvec3& direction, double drawn_by) const {
    if (!environment_) return options_.environment;
    const bool is_shared = options_.sample_lights && drawn_by != kInfinity;
    const double share = is_shared ? drawn_by / (drawn_by + environment_->density(direction)) : 1;
    return share * environment_->radiance(direction);
  }

  glm::dvec3 direct(const Point& p, const Scattering& scattering, const Material* medium,
                    Random& random) const {
    glm::dvec3 sum(0);
    if (!area_lights_.empty()) sum += from_area(p, scattering, medium, random);
    if (environment_) sum += from_environment(p, scattering, medium, random);
    for (const PunctualLight& light : scene_.lights) sum += from_punctual(p, light, medium);
    return sum;
  }

  glm::dvec3 from_area(const Point& p, const Scattering& scattering, const Material* medium,
                       Random& random) const {
    const AreaLights::Sample light = area_lights_.sample(p.position, random);
    const glm::dvec3 way = light.position - p.position;
    const double distance = glm::length(way);
    const glm::dvec3 direction = way / distance;
    const glm::dvec3 part = scattered_part(p, direction);
    if (part == glm::dvec3(0)) return part;
    const Point there = point_at(scene_, light.place, light.position, -direction);
    const glm::dvec3 radiance = chance_to_stop(scene_, light.place) * emitted(there);
    const double facing = glm::dot(there.face, there.eye);
    if (radiance == glm::dvec3(0) || facing == 0) return glm::dvec3(0);
    const double relative = epsilon_ / distance;
    const double passes = passing({p.position, way}, relative, 1 - relative);
    const double by_light = light.density * distance * distance / facing;
    return passes * part * radiance * transmittance(medium_beyond(p, direction, medium), distance) /
           (by_light + scattering.density(direction));
  }

  glm::dvec3 from_environment(const Point& p, const Scattering& scattering, const Material* medium,
                              Random& random) const {
    const Environment::Sample sky = environment_->sample(random);
    const glm::dvec3 part = scattered_part(p, sky.direction);
    if (part == glm::dvec3(0)) return part;
    return passing({p.position, sky.direction}, epsilon_, kInfinity) * part *
           environment_->radiance(sky.direction) *
           transmittance(medium_beyond(p, sky.direction, medium), kInfinity) /
           (sky.density + scattering.density(sky.direction));
  }

  glm::dvec3 from_punctual(const Point& p, const PunctualLight& light, const Material* medium) const {
    const Arriving lit = arriving(light, p.position);
    const glm::dvec3 part = scattered_part(p, lit.to_light) * lit.irradiance;
    if (part == glm::dvec3(0)) return part;
    return passing({p.position, lit.to_light}, epsilon_, lit.distance) * part *
           transmittance(medium_beyond(p, lit.to_light, medium), lit.distance);
  }

  const Scene& scene_;
  Options options_;
  Bvh bvh_;
  AreaLights area_lights_;
  std::optional<Environment> environment_;
  double epsilon_ = 0;
};

}  // namespace

Image trace(const Scene& scene, const Options& options) {
  const Tracer tracer(scene, options);
  const auto pixels = static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
  Image image{std::vector<glm::dvec3>(pixels), std::vector<glm::dvec3>(pixels)};
  const auto render_pixel = [&](std::size_t i) {
    Random random{std::mt19937_64(options.seed * 0x9e3779b97f4a7c15ULL + i)};
    glm::dvec3 sum(0), squares(0);
    for (int s = 0; s < options.samples; ++s) {
      const auto width = static_cast<std::size_t>(options.width);
      const glm::dvec3 radiance =
          tracer.sample(static_cast<int>(i % width), static_cast<int>(i / width), random);
      sum += radiance;
      squares += radiance * radiance;
    }
    const double n = options.samples;
    image.mean[i] = sum / n;
    image.variance[i] = glm::max(squares / n - image.mean[i] * image.mean[i], 0.0) / (n - 1);
  };
  const std::size_t threads = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::jthread> workers;
  for (std::size_t k = 0; k < threads; ++k) {
    workers.emplace_back([&, k] {
      for (std::size_t i = k; i < pixels; i += threads) render_pixel(i);
    });
  }
  workers.clear();  // joins
  return image;
}

std::vector<char> edges_of_lights(const Scene& scene, const Options& options) {
  const Tracer tracer(scene, options);
  std::vector<char> edges;
  for (int y = 0; y < options.height; ++y) {
    for (int x = 0; x < options.width; ++x) edges.push_back(tracer.sees_edge_of_light(x, y) ? 1 : 0);
  }
  return edges;
}

}  // namespace qtrace::independent
