// A lamp in the plane of a larger ceiling gives all of its light, by every method and in every order of the objects.
#include "engine/gltf/overlaps.h"
#include "tests/render/comparison.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace qtrace::test {
namespace {

bool emits(const Scene& scene, const Object& object) {
  return scene.materials[scene.triangles[object.first_triangle].material].emission != glm::vec3(0);
}

float highest(const Scene& scene) {
  float most = -std::numeric_limits<float>::infinity();
  for (const Triangle& triangle : scene.triangles) {
    for (const glm::vec3& p : triangle.position) most = std::max(most, p.y);
  }
  return most;
}

// The Cornell box with its lamp lifted into the plane of the ceiling, the lamp as the first or as the last object.
Scene box_with_lamp_in_ceiling(bool lamp_first) {
  Scene from = shipped("cornell_box.glb");
  const float ceiling = highest(from);
  Scene box = from;
  box.triangles.clear();
  box.objects.clear();
  for (const bool lamps : {lamp_first, !lamp_first}) {
    for (const Object& object : from.objects) {
      if (emits(from, object) != lamps) continue;
      Object moved = object;
      moved.first_triangle = static_cast<std::uint32_t>(box.triangles.size());
      for (std::uint32_t i = 0; i < object.triangle_count; ++i) {
        Triangle triangle = from.triangles[object.first_triangle + i];
        triangle.object = static_cast<std::uint32_t>(box.objects.size());
        for (glm::vec3& p : triangle.position) p.y = lamps ? ceiling : p.y;
        box.triangles.push_back(triangle);
      }
      box.objects.push_back(moved);
    }
  }
  return box;
}

Rendering render_box(const Scene& box, const Method& method, std::uint32_t seed, int frames) {
  return render(box, with_method(base_settings(seed), method), frames);
}

const Method kTruth{"", Sampler::bsdf, Nee::one_ray, {}};

class Coplanar : public testing::TestWithParam<bool> {
 protected:
  static Scene mended(bool lamp_first) {
    Scene box = box_with_lamp_in_ceiling(lamp_first);
    gltf::Source source{"box", {}, {}, 0, {}};
    gltf::cut_overlaps(source, box, 0, 1000);
    EXPECT_EQ(source.warnings.size(), 1U);
    return box;
  }
};

TEST_P(Coplanar, AllMethodsAgree) {
  const Scene box = mended(GetParam());
  const Rendering truth = render_box(box, kTruth, 900, 192);
  std::uint32_t seed = 1;
  for (const Method& method : all_methods()) {
    SCOPED_TRACE(method.name);
    expect_same_image(render_box(box, method, seed++, 96), truth, all_methods().size() * kBlocks);
  }
}

TEST_P(Coplanar, TheOrderMakesNoDifference) {
  const Rendering one = render_box(mended(GetParam()), kTruth, 901, 128);
  const Rendering other = render_box(mended(!GetParam()), kTruth, 902, 128);
  expect_same_image(one, other, kBlocks);
}

INSTANTIATE_TEST_SUITE_P(Orders, Coplanar, testing::Bool(),
                         [](const auto& order) { return order.param ? "LampFirst" : "LampLast"; });

}  // namespace
}  // namespace qtrace::test
