// No ray leaves a closed surface: neither between neighbouring triangles, nor from a point whose rounding put
// it behind the wall next to it.
#include "engine/accel/build_bvh.h"
#include "engine/device_scene/scene_buffers.h"
#include "engine/scene/analytic.h"
#include "engine/tracer/parameters.h"
#include "tests/support/bumpy_ball.h"
#include "tests/support/probe.h"
#include "tests/support/ray_queries.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <random>

namespace qtrace::test {
namespace {

constexpr std::uint32_t kRays = 1 << 18;

struct Aim {
  glm::vec4 from;
  glm::vec4 to;
};

// Rays from about the middle to points on edges, some of them to their ends.
std::vector<Aim> aims_at_edges(const Scene& scene, glm::vec3 middle) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform;
  std::vector<Aim> aims(kRays);
  for (Aim& aim : aims) {
    const auto& p = scene.triangles[random() % scene.triangles.size()].position;
    const std::size_t corner = random() % 3;
    const float along = random() % 4 == 0 ? 0 : uniform(random);
    const glm::vec3 spread = glm::vec3(uniform(random), uniform(random), uniform(random)) - 0.5F;
    aim.from = glm::vec4(middle + 0.2F * spread, 0);
    aim.to = glm::vec4(glm::mix(p[corner], p[(corner + 1) % 3], along), 0);
  }
  return aims;
}

// What `body` makes of every aim: the number of results that are not zero.
std::size_t count_leaks(const Scene& scene, const Walk& walk, glm::vec3 middle, const std::string& body) {
  device();
  const Bvh bvh = build_bvh(scene, walk.kind);
  const gpu::SceneBuffers buffers(scene, bvh);
  buffers.bind();
  const std::vector<Aim> aims = aims_at_edges(scene, middle);
  const gpu::Buffer input("aims", std::span<const Aim>(aims));
  input.bind_storage(gpu::BINDING_SAMPLES);
  std::size_t leaks = 0;
  for (const glm::uvec4& r : probe<glm::uvec4>(
           "uvec4",
           {"geometry/surface.glsl", "geometry/traverse.glsl", "sampling/random.glsl", "shared/loops.glsl"},
           "struct Aim { vec4 from; vec4 to; };\n"
           "layout(std430, binding = BINDING_SAMPLES) readonly buffer AimBuffer { Aim aims[]; };",
           "vec3 from = aims[index].from.xyz;\nvec3 direction = normalize(aims[index].to.xyz - from);\n"
           "Hit hit = closest_hit(from, direction);\n" +
               body,
           kRays, walk.defines)) {
    leaks += r.x;
  }
  return leaks;
}

class Watertight : public testing::TestWithParam<Walk> {};

TEST_P(Watertight, NoRayPassesBetweenNeighbours) {
  for (const glm::vec3 middle : {glm::vec3(0), glm::vec3(3, -7, 20)}) {
    EXPECT_EQ(count_leaks(bumpy_ball(middle), GetParam(), middle,
                          "result = uvec4(hit.triangle == NO_TRIANGLE ? 1u : 0u);"),
              0U);
  }
}

// A cube that is askew to the axes, so that its walls' points are rounded to either side of them.
Scene turned_box() {
  Scene scene = furnace_box(0.5F, 0);
  const glm::mat4 turn = glm::rotate(glm::mat4(1), 0.7F, glm::normalize(glm::vec3(1, 2, -0.6F)));
  for (Triangle& t : scene.triangles) {
    for (glm::vec3& p : t.position) p = glm::vec3(turn * glm::vec4(p, 1));
    for (glm::vec3& n : t.normal) n = glm::vec3(turn * glm::vec4(n, 0));
  }
  return scene;
}

// From points on the edges of a box, a ray anywhere into the hemisphere of the wall that was met.
TEST_P(Watertight, NoRayStartsBehindTheNextWall) {
  const std::string body =
      "if (hit.triangle == NO_TRIANGLE) { results[index] = uvec4(1u); return; }\n"
      "Surface s = surface_at(hit, direction);\n"
      "vec4 u = random_units(RandomKey(index, 1u, 3u), 1u);\n"
      "float r = sqrt(1.0 - u.x * u.x);\n"
      "vec3 local = vec3(r * cos(2.0 * PI * u.y), r * sin(2.0 * PI * u.y), u.x);\n"
      "vec3 away = to_world(local, tangent_of(s.geometric_normal), s.geometric_normal);\n"
      "result = uvec4(closest_hit(ray_origin(s, away), away).triangle == NO_TRIANGLE ? 1u : 0u);";
  for (const Scene& scene : {furnace_box(0.5F, 0), turned_box()}) {
    EXPECT_EQ(count_leaks(scene, GetParam(), glm::vec3(0), body), 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Watertight, testing::ValuesIn(walks()), name_of);

}  // namespace
}  // namespace qtrace::test
