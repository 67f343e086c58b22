// Rays for tests of the queries of shaders/traverse.glsl.
#pragma once

#include "engine/accel/bvh.h"
#include "engine/gpu/shader_source.h"

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace qtrace::test {

struct RayPair {
  glm::vec4 origin;
  glm::vec4 direction;  // unit
};

// As shaders see them: a storage buffer of them, bound as the samples are.
inline const std::string kRayBuffer =
    "struct RayPair { vec4 origin; vec4 direction; };\n"
    "layout(std430, binding = BINDING_SAMPLES) readonly buffer RayBuffer { RayPair rays[]; };";

// Between random points of the scene's box, made larger by `more` on every side.
inline std::vector<RayPair> random_rays(const Bvh& bvh, std::size_t count, std::uint32_t seed,
                                        float more = 0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform;
  const auto point = [&] {
    const glm::vec3 u(uniform(random), uniform(random), uniform(random));
    return bvh.nodes[0].lo - more + u * (bvh.nodes[0].hi - bvh.nodes[0].lo + 2 * more);
  };
  std::vector<RayPair> rays(count);
  for (RayPair& ray : rays) {
    ray.origin = glm::vec4(point(), 0);
    ray.direction = glm::vec4(glm::normalize(point() - glm::vec3(ray.origin)), 0);
  }
  return rays;
}

// Of the shaders that walk this kind of hierarchy.
inline gpu::Defines defines_of(BvhKind kind) { return {{"BVH", std::to_string(static_cast<int>(kind))}}; }

}  // namespace qtrace::test
