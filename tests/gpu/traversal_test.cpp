// The GPU's traversal against the CPU's in double precision, and against the driver's loop budget.
#include "engine/accel/build_bvh.h"
#include "engine/accel/traverse.h"
#include "engine/core/check.h"
#include "engine/device_scene/scene_buffers.h"
#include "engine/scene/analytic.h"
#include "engine/gltf/load_gltf.h"
#include "tests/support/probe.h"
#include "tests/support/ray_queries.h"
#include "tests/support/render.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <random>

namespace qtrace::test {
namespace {

constexpr std::uint32_t kRays = 20000;

void expect_same_hits(const Scene& scene, const Walk& walk, float more = 0) {
  device();
  const Bvh bvh = build_bvh(scene, walk.kind);
  const gpu::SceneBuffers buffers(scene, bvh);
  buffers.bind();
  const std::vector<RayPair> rays = random_rays(bvh, kRays, 3, more);
  const gpu::Buffer input("rays", std::span<const RayPair>(rays));
  input.bind_storage(gpu::BINDING_SAMPLES);
  const auto hits = probe<glm::uvec4>(
      "uvec4", {"geometry/traverse.glsl"}, kRayBuffer,
      "Hit hit = closest_hit(rays[index].origin.xyz, rays[index].direction.xyz);\n"
      "bool occluded = is_occluded(rays[index].origin.xyz, rays[index].direction.xyz * hit.t * 0.999);\n"
      "bool found = is_occluded(rays[index].origin.xyz, rays[index].direction.xyz * min(hit.t, 1e4) * "
      "1.001);\n"
      "result = uvec4(hit.triangle, floatBitsToUint(hit.t), (occluded ? 1u : 0u) | (found ? 2u : 0u), "
      "loop_was_cut ? 1u : 0u);",
      kRays, walk.defines);
  int differences = 0;
  for (std::uint32_t i = 0; i < kRays; ++i) {
    const auto truth = closest_hit(scene, bvh, {glm::dvec3(rays[i].origin), glm::dvec3(rays[i].direction)});
    const bool hit = hits[i].x != gpu::NO_TRIANGLE;
    const double t = std::bit_cast<float>(hits[i].y);
    EXPECT_EQ(hits[i].w, 0U);
    // A ray through an edge may pass on the other side of it in single precision: the distance decides.
    if (hit != truth.has_value() || (hit && std::abs(t - truth->t) > 1e-4 * truth->t)) ++differences;
    if (hit) {
      EXPECT_EQ(hits[i].z, 2U) << "shadow rays disagree with the closest hit at ray " << i;
    }
  }
  // One in 5,000 may graze an edge or a silhouette.
  EXPECT_LE(differences, static_cast<int>(kRays / 5000));
}

class TraversalOf : public testing::TestWithParam<Walk> {};

TEST_P(TraversalOf, AgreesWithTheOracle) {
  expect_same_hits(load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/simple.glb"), GetParam());
  expect_same_hits(load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/cornell_box.glb"), GetParam());
  expect_same_hits(load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/many_lights.glb"), GetParam());
}

// A box that is flat, and a root that is a leaf.
TEST_P(TraversalOf, AgreesWithTheOracleOnFewTriangles) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.5F))};
  add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 0);
  scene.camera = look_at({1, 1, 1}, {0, 0, 0}, 1.0F);
  expect_same_hits(scene, GetParam(), 1);
  scene.triangles.resize(1);
  expect_same_hits(scene, GetParam(), 1);
}

INSTANTIATE_TEST_SUITE_P(Kinds, TraversalOf, testing::ValuesIn(walks()), name_of);

TEST(Traversal, OracleAgreesWithExhaustiveSearch) {
  const Scene scene = load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/simple.glb");
  const Bvh bvh = build_bvh(scene, BvhKind::threaded);
  const std::vector<RayPair> rays = random_rays(bvh, kRays, 3);
  for (std::size_t i = 0; i < 200; ++i) {
    const Ray ray{glm::dvec3(rays[i].origin), glm::dvec3(rays[i].direction)};
    std::optional<RayHit> best;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
      const auto hit = intersect_triangle(scene, t, ray);
      if (hit && (!best || hit->t < best->t)) best = hit;
    }
    const auto found = closest_hit(scene, bvh, ray);
    ASSERT_EQ(found.has_value(), best.has_value());
    if (best) {
      EXPECT_EQ(found->t, best->t);
    }
  }
}

// Coincident dark triangles, and behind them in the hierarchy, nearer to the camera, one that emits: a walk
// that is cut short shows black. Drivers that bound loops must not do that unseen: the image is right, or
// there is an error.
TEST_P(TraversalOf, LoopBudgetIsNeverExceededInSilence) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.5F)), lambert(glm::vec3(0.5F), glm::vec3(1.0F))};
  constexpr int kLayers = 70000;
  for (int i = 0; i < kLayers; ++i) add_quad(scene, {-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, 0);
  add_quad(scene, {-5, 0.01F, -5}, {0, 0, 10}, {10, 0, 0}, 1);
  scene.camera = look_at({1, 2, 1}, {0, 0, 0}, 0.3F);
  RenderSettings settings;
  settings.width = settings.height = 8;
  settings.max_bounces = 1;
  settings.sampler = Sampler::bsdf;
  settings.bvh = GetParam().kind;
  try {
    Tracer tracer(device(), scene, settings, GetParam().defines);
    const Rendering r = render(tracer, 1);
    for (const glm::dvec3& pixel : r.image.mean) EXPECT_DOUBLE_EQ(pixel.r, 1);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("cut a shader loop"), std::string::npos) << error.what();
    EXPECT_TRUE(device().device().software);
  }
}

}  // namespace
}  // namespace qtrace::test
