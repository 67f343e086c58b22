// Ray queries by the million: against the oracle in double precision, every difference explained, and into
// closed surfaces, which no ray may leave.
#include "engine/accel/build_bvh.h"
#include "engine/accel/traverse.h"
#include "engine/device_scene/scene_buffers.h"
#include "engine/gltf/load_gltf.h"
#include "engine/gpu/driver.h"
#include "tests/support/bumpy_ball.h"
#include "tests/support/probe.h"
#include "tests/support/ray_queries.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <random>

namespace qtrace::test {
namespace {

constexpr std::uint32_t kBatch = 1 << 18;
constexpr int kOracleBatches = 13;  // 3.4 million rays for each of three scenes: 10.2 million
constexpr int kLeakBatches = 1908;  // of each of two balls: 10^9 rays in all
constexpr double kBorder =
    1e-4;  // of barycentric weights: where single precision may see a ray on either side
constexpr double kDistance = 1e-4;  // of t, relative
// Of t, in units of the largest coordinate: 4 units in the last place.
constexpr double kRounding = 4.0 / 16777216.0;

// Smallest barycentric weight and t of a ray's plane hit, in double precision.
struct PlaneHit {
  double weight;
  double t;
};

PlaneHit plane_hit(const Triangle& triangle, const Ray& ray) {
  const glm::dvec3 a(triangle.position[0]);
  const glm::dvec3 edge1 = glm::dvec3(triangle.position[1]) - a;
  const glm::dvec3 edge2 = glm::dvec3(triangle.position[2]) - a;
  const glm::dvec3 p = glm::cross(ray.direction, edge2);
  const double det = glm::dot(edge1, p);
  const glm::dvec3 q = glm::cross(ray.origin - a, edge1);
  const double u = glm::dot(ray.origin - a, p) / det;
  const double v = glm::dot(ray.direction, q) / det;
  return {std::min({u, v, 1 - u - v}), glm::dot(edge2, q) / det};
}

// A difference is one of rounding if the ray passes the border of the nearest triangle that only one side has
// met, or starts on it.
bool is_explained(const Scene& scene, const Bvh& bvh, const Ray& ray, const std::optional<RayHit>& truth,
                  std::uint32_t found, double rounding) {
  const bool hit = found != gpu::NO_TRIANGLE;
  const PlaneHit ours = hit ? plane_hit(scene.triangles[bvh.order[found]], ray) : PlaneHit{0, 0};
  if (hit && (ours.weight < -kBorder || ours.t <= -rounding)) return false;  // it is not there
  const bool truth_is_nearer = truth && (!hit || truth->t < ours.t);
  const PlaneHit nearer = truth_is_nearer ? plane_hit(scene.triangles[truth->triangle], ray) : ours;
  return std::abs(nearer.weight) < kBorder || std::abs(nearer.t) < rounding;
}

void compare_with_oracle(const std::string& name, const Walk& walk) {
  device();
  const Scene scene = load_gltf(std::string(QTRACE_SOURCE_DIR "/configs/scenes/") + name);
  const Bvh bvh = build_bvh(scene, walk.kind);
  const gpu::SceneBuffers buffers(scene, bvh);
  buffers.bind();
  const glm::vec3 size = glm::max(glm::abs(bvh.nodes[0].lo), glm::abs(bvh.nodes[0].hi));
  const double rounding = kRounding * double{std::max({size.x, size.y, size.z})};
  std::size_t differences = 0;
  std::size_t unexplained = 0;
  for (std::uint32_t batch = 0; batch < kOracleBatches; ++batch) {
    const std::vector<RayPair> rays = random_rays(bvh, kBatch, 100 + batch);
    const gpu::Buffer input("rays", std::span<const RayPair>(rays));
    input.bind_storage(gpu::BINDING_SAMPLES);
    const auto hits =
        probe<glm::uvec4>("uvec4", {"geometry/traverse.glsl"}, kRayBuffer,
                          "Hit hit = closest_hit(rays[index].origin.xyz, rays[index].direction.xyz);\n"
                          "result = uvec4(hit.triangle, floatBitsToUint(hit.t), loop_was_cut ? 1u : 0u, 0u);",
                          kBatch, walk.defines);
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      const Ray ray{glm::dvec3(rays[i].origin), glm::dvec3(rays[i].direction)};
      const auto truth = closest_hit(scene, bvh, ray);
      ASSERT_EQ(hits[i].z, 0U);
      const bool hit = hits[i].x != gpu::NO_TRIANGLE;
      const double t = std::bit_cast<float>(hits[i].y);
      if (hit == truth.has_value() && (!hit || std::abs(t - truth->t) <= kDistance * truth->t + rounding))
        continue;
      ++differences;
      if (is_explained(scene, bvh, ray, truth, hits[i].x, rounding)) continue;
      ++unexplained;
      ADD_FAILURE() << fmt::format("ray {} of batch {}: triangle {} at {}, where the oracle has {} at {}", i,
                                   batch, hits[i].x, t, truth ? int(truth->triangle) : -1,
                                   truth ? truth->t : 0);
    }
  }
  fmt::print("{} {}: {} differences in {} rays, {} unexplained\n", name, walk.name, differences,
             std::uint64_t{kBatch} * kOracleBatches, unexplained);
}

class SlowRays : public testing::TestWithParam<Walk> {};

TEST_P(SlowRays, TenMillionAgreeWithTheOracle) {
  for (const char* name : {"simple.glb", "cornell_box.glb", "many_lights.glb"})
    compare_with_oracle(name, GetParam());
}

// How many of so many batches of rays leave a ball: from about its middle to points on edges, a quarter of
// them corners.
std::uint64_t leaks_of(const Scene& scene, glm::vec3 middle, const Walk& walk, std::uint32_t batches) {
  const gpu::SceneBuffers buffers(scene, build_bvh(scene, walk.kind));
  buffers.bind();
  const std::string body = fmt::format(
      "vec4 u = random_units(RandomKey(index, frame_number, 1u), 1u);\n"
      "vec4 w = random_units(RandomKey(index, frame_number, 1u), 2u);\n"
      "uint triangle = min(uint(u.x * {0}.0), {0}u - 1u);\n"
      "uint corner = min(uint(u.y * 3.0), 2u);\n"
      "float along = max(u.z * 4.0 / 3.0 - 1.0 / 3.0, 0.0);\n"
      "vec3 from = vec3({1}, {2}, {3}) + 0.2 * (w.xyz - 0.5);\n"
      "vec3 to = mix(vertex_of(triangle, corner), vertex_of(triangle, (corner + 1u) % 3u), along);\n"
      "Hit hit = closest_hit(from, normalize(to - from));\n"
      "if (hit.triangle == NO_TRIANGLE || loop_was_cut) atomicAdd(results[0], 1u);",
      scene.triangles.size(), middle.x, middle.y, middle.z);
  gpu::Program program(
      gpu::assemble("leaks",
                    "#version 450 core\n#include \"geometry/traverse.glsl\"\n#include "
                    "\"sampling/random.glsl\"\nlayout(local_size_x = 64) in;\n"
                    "layout(std430, binding = BINDING_OUTPUT) buffer Results { uint results[]; };\n"
                    "void main() { uint index = gl_GlobalInvocationID.x;\n" +
                        body + "}\n",
                    gpu::for_driver(walk.defines)));
  gpu::Buffer output("leaks", 16);
  output.bind_storage(gpu::BINDING_OUTPUT);
  for (std::uint32_t batch = 1; batch <= batches; ++batch) {
    program.set_frame(batch);
    program.dispatch(kBatch / 64);
  }
  device().finish();
  return output.read_all<std::uint32_t>()[0];
}

TEST_P(SlowRays, ABillionDoNotLeaveClosedSurfaces) {
  device();
  for (const glm::vec3 middle : {glm::vec3(0), glm::vec3(3, -7, 20)}) {
    Scene scene = bumpy_ball(middle);
    const std::uint64_t leaks = leaks_of(scene, middle, GetParam(), kLeakBatches);
    fmt::print("{}: {} leaks of {} rays\n", GetParam().name, leaks, std::uint64_t{kBatch} * kLeakBatches);
    EXPECT_EQ(leaks, 0U);
    // Where a triangle is left out, they do.
    scene.triangles.pop_back();
    --scene.objects[0].triangle_count;
    EXPECT_GT(leaks_of(scene, middle, GetParam(), 1), 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, SlowRays, testing::ValuesIn(own_walks()), name_of);

}  // namespace
}  // namespace qtrace::test
