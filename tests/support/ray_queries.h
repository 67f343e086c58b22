// Rays for tests of the queries of shaders/geometry/traverse.glsl.
#pragma once

#include "engine/accel/bvh.h"
#include "engine/gpu/driver.h"
#include "engine/gpu/shader_source.h"

#include <gtest/gtest.h>
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

// A way to walk a hierarchy of this kind.
struct Walk {
  std::string name;
  BvhKind kind;
  gpu::Defines defines;
};

// The ones of this device.
inline std::vector<Walk> own_walks() {
  const auto number = [](BvhKind kind) { return std::to_string(static_cast<int>(kind)); };
  return {{"sah", BvhKind::sah, {{"BVH", number(BvhKind::sah)}}},
          {"threaded", BvhKind::threaded, {{"BVH", number(BvhKind::threaded)}}}};
}

// And GPUs', on whatever this device is.
inline std::vector<Walk> walks() {
  std::vector<Walk> all = own_walks();
  all.push_back(all.front());
  all.back().name = "sah_as_on_gpus";
  all.back().defines["STACK"] = std::to_string(static_cast<int>(gpu::StackPlace::memory));
  all.back().defines["FETCH"] = std::to_string(static_cast<int>(gpu::Fetch::texture));
  return all;
}

inline std::string name_of(const testing::TestParamInfo<Walk>& walk) { return walk.param.name; }

inline void PrintTo(const Walk& walk, std::ostream* out) { *out << walk.name; }

}  // namespace qtrace::test
