#include "tests/independent/path_tracer.h"

#include "tests/independent/bvh.h"
#include "tests/independent/material.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <thread>

namespace qtrace::independent {
namespace {

constexpr double kPi = glm::pi<double>();
constexpr int kLattice = 17;  // rays each way in which a pixel is searched for a light's edge

struct Random {
  std::mt19937_64 bits;
  double operator()() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
};

// A point that scatters, as seen by `eye`.
struct Point {
  glm::dvec3 position, eye;  // eye: direction towards where the ray came from
  glm::dvec3 face, normal;   // geometric and interpolated, on the side of the eye
  bool from_front = true;
  const Material* material = nullptr;
};

class Tracer {
 public:
  Tracer(const Scene& scene, const Options& options) : scene_(scene), options_(options), bvh_(scene) {
    glm::dvec3 lo(1e300), hi(-1e300);
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
      for (const glm::vec3& p : scene.triangles[i].position)
        lo = glm::min(lo, glm::dvec3(p)), hi = glm::max(hi, glm::dvec3(p));
      const glm::dvec3 emission(scene.materials[scene.triangles[i].material].emission);
      const double power = area_of(scene.triangles[i]) * (emission.x + emission.y + emission.z);
      if (power > 0) lights_.push_back({i, power});
    }
    epsilon_ = 1e-9 * glm::length(hi - lo);
  }

  bool sees_edge_of_light(int x, int y) const {
    const glm::dvec3 corner = seen(camera_ray(x, y));
    for (int k = 1; k < kLattice * kLattice; ++k) {
      const double dx = k % kLattice, dy = k / kLattice;
      if (seen(camera_ray(x + dx / (kLattice - 1), y + dy / (kLattice - 1))) != corner) return true;
    }
    return false;
  }

  glm::dvec3 sample(int x, int y, Random& random) const {
    Ray ray = camera_ray(x + random(), y + random());
    glm::dvec3 radiance(0), throughput(1);
    double drawn_by = 0;  // density of the ray's direction
    for (int bounce = 0;; ++bounce) {
      const Hit hit = bvh_.closest(ray, epsilon_);
      if (!hit) return radiance + throughput * options_.environment;
      const Point p = point(ray, hit);
      const glm::dvec3 emission = emitted(*p.material, p.from_front);
      const bool is_shared = bounce > 0 && options_.sample_lights && emission != glm::dvec3(0);
      const double share = is_shared ? drawn_by / (drawn_by + light_density(ray.origin, hit.triangle, p)) : 1;
      radiance += throughput * emission * share;
      if (bounce == options_.max_bounces) return radiance;
      if (options_.sample_lights) radiance += throughput * direct(p, random);
      const glm::dvec3 direction = scattered(p, random);
      const double cosine = glm::dot(direction, p.normal);
      if (cosine <= 0 || glm::dot(direction, p.face) <= 0) return radiance;
      drawn_by = density(p, direction);
      throughput *= reflect(*p.material, p.normal, direction, p.eye) * (cosine / drawn_by);
      if (throughput == glm::dvec3(0)) return radiance;
      ray = {p.position, direction};
    }
  }

 private:
  Ray camera_ray(double x, double y) const {
    const glm::dmat4 m(scene_.camera.world_from_camera);
    const double up = std::tan(0.5 * scene_.camera.vertical_fov);
    const double right = up * options_.width / options_.height;
    const glm::dvec4 d((2 * x / options_.width - 1) * right, (1 - 2 * y / options_.height) * up, -1, 0);
    return {glm::dvec3(m[3]), glm::normalize(glm::dvec3(m * d))};
  }

  Point point(const Ray& ray, const Hit& hit) const {
    const Triangle& t = scene_.triangles[hit.triangle];
    Point p;
    p.position = ray.origin + hit.t * ray.direction;
    p.eye = -glm::normalize(ray.direction);
    p.material = &scene_.materials[t.material];
    const glm::dvec3 face = glm::normalize(area_vector(t.position));
    p.from_front = glm::dot(face, p.eye) > 0;
    const double side = p.from_front ? 1 : -1;
    p.face = side * face;
    p.normal = side * glm::normalize((1 - hit.u - hit.v) * glm::dvec3(t.normal[0]) +
                                     hit.u * glm::dvec3(t.normal[1]) + hit.v * glm::dvec3(t.normal[2]));
    if (!(glm::dot(p.normal, p.eye) > 0)) p.normal = p.face;  // it faces away from the ray, or is none
    return p;
  }

  glm::dvec3 seen(const Ray& ray) const {
    const Hit hit = bvh_.closest(ray, epsilon_);
    if (!hit) return options_.environment;
    const Point p = point(ray, hit);
    return emitted(*p.material, p.from_front);
  }

  static glm::dvec3 emitted(const Material& material, bool front) {
    return front || material.double_sided ? glm::dvec3(material.emission) : glm::dvec3(0);
  }

  struct Light {
    std::uint32_t triangle;
    double power;
  };

  // Its power over the squared distance of its middle; its area keeps that finite.
  double weight(const Light& light, const glm::dvec3& from) const {
    const Triangle& t = scene_.triangles[light.triangle];
    const glm::dvec3 way =
        (glm::dvec3(t.position[0]) + glm::dvec3(t.position[1]) + glm::dvec3(t.position[2])) / 3.0 - from;
    return light.power / (glm::dot(way, way) + area_of(t));
  }

  struct Choice {
    const Light* light;
    double chance;
  };

  Choice choose_light(const glm::dvec3& from, Random& random) const {
    double sum = 0;
    for (const Light& light : lights_) sum += weight(light, from);
    double left = random() * sum;
    for (const Light& light : lights_) {
      const double w = weight(light, from);
      if (left < w || &light == &lights_.back()) return {&light, w / sum};
      left -= w;
    }
    return {};
  }

  // Per solid angle as seen from there, of drawing this point of a light.
  double light_density(const glm::dvec3& from, std::uint32_t triangle, const Point& p) const {
    double sum = 0, own = 0;
    for (const Light& light : lights_) {
      const double w = weight(light, from);
      sum += w;
      if (light.triangle == triangle) own = w;
    }
    const glm::dvec3 way = p.position - from;
    return own / sum / area_of(scene_.triangles[triangle]) * glm::dot(way, way) / glm::dot(p.face, p.eye);
  }

  // One light, and one point on it by area. By the balance heuristic: Veach & Guibas 1995.
  glm::dvec3 direct(const Point& p, Random& random) const {
    if (lights_.empty()) return glm::dvec3(0);
    const Choice choice = choose_light(p.position, random);
    const Triangle& light = scene_.triangles[choice.light->triangle];
    const double root = std::sqrt(random());
    const double part = random();
    const glm::dvec3 target = (1 - root) * glm::dvec3(light.position[0]) +
                              root * (1 - part) * glm::dvec3(light.position[1]) +
                              root * part * glm::dvec3(light.position[2]);
    const glm::dvec3 way = target - p.position;
    const double distance2 = glm::dot(way, way);
    const glm::dvec3 direction = way / std::sqrt(distance2);
    const double facing = -glm::dot(glm::normalize(area_vector(light.position)), direction);
    const glm::dvec3 radiance = emitted(scene_.materials[light.material], facing > 0);
    if (glm::dot(direction, p.normal) <= 0 || glm::dot(direction, p.face) <= 0 || radiance == glm::dvec3(0)) {
      return glm::dvec3(0);
    }
    const double relative = epsilon_ / std::sqrt(distance2);
    if (bvh_.closest({p.position, way}, relative, 1 - relative)) return glm::dvec3(0);
    const double by_light = choice.chance / area_of(light) * distance2 / std::abs(facing);
    return reflect(*p.material, p.normal, direction, p.eye) * radiance *
           (glm::dot(direction, p.normal) / (by_light + density(p, direction)));
  }

  // Half of all directions go by the cosine, half by the microfacets; all by the cosine where there are none.
  static glm::dvec3 scattered(const Point& p, Random& random) {
    const double phi = 2 * kPi * random();
    const double u = random();
    if (!has_lobe(*p.material) || random() < 0.5) return about(p.normal, std::sqrt(1 - u), phi);
    const double a2 = std::pow(double{p.material->roughness}, 4);
    const glm::dvec3 h = about(p.normal, std::sqrt((1 - u) / (1 + (a2 - 1) * u)), phi);
    return 2 * glm::dot(p.eye, h) * h - p.eye;
  }

  static double density(const Point& p, const glm::dvec3& direction) {
    const double by_cosine = glm::dot(direction, p.normal) / kPi;
    if (!has_lobe(*p.material)) return by_cosine;
    const glm::dvec3 h = glm::normalize(direction + p.eye);
    const double n_h = glm::dot(p.normal, h);
    return 0.5 * by_cosine + 0.5 * facet_distribution(*p.material, n_h) * n_h / (4 * glm::dot(p.eye, h));
  }

  // The direction at an angle of this cosine to n.
  static glm::dvec3 about(const glm::dvec3& n, double cosine, double phi) {
    const glm::dvec3 other = std::abs(n.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 t = glm::normalize(glm::cross(n, other));
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return glm::normalize(cosine * n + sine * (std::cos(phi) * t + std::sin(phi) * glm::cross(n, t)));
  }

  const Scene& scene_;
  Options options_;
  Bvh bvh_;
  std::vector<Light> lights_;
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
