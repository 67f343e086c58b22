// Light samples bring the same light as the paths alone, whatever stands between and however it scatters.
#include "tests/independent/small_scenes.h"

#include <string>

namespace qtrace::independent {
namespace {

struct Case {
  std::string name;
  Material material;
  glm::vec3 eye;
};

std::vector<Case> cases() {
  const glm::vec3 above(0.6F, 0.5F, 0.7F), below(0.3F, -0.5F, 0.2F);
  Material volume = glass(0.5F, false);
  volume.attenuation_color = {0.9F, 0.5F, 0.2F};
  volume.attenuation_distance = 1;
  Material coated = glass(0.4F, true);
  coated.transmission = 0.5F;
  coated.clearcoat = 0.7F;
  coated.clearcoat_roughness = 0.3F;
  Material smooth_coat = lambert(glm::vec3(0.7F));
  smooth_coat.clearcoat = 1;
  Material half_there = coated;
  half_there.alpha_mode = AlphaMode::blend;
  half_there.opacity = 0.6F;
  return {{"thin", glass(0.5F, true), above}, {"thin from below", glass(0.5F, true), below},
          {"into a volume", volume, above},   {"out of a volume", volume, below},
          {"coated", coated, above},          {"smooth coat", smooth_coat, above},
          {"partly there", half_there, above}};
}

// A floor between a lamp above, which is coated, and one below, under a sky with a spot.
Scene lit_from_all_sides(const Material& material) {
  Scene scene;
  Material lamp = emitter({4, 2, 1});
  lamp.clearcoat = 0.5F;
  lamp.double_sided = true;
  scene.materials = {material, lamp};
  add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 0);
  add_quad(scene, {-0.9F, 1, -0.9F}, {0.8F, 0, 0}, {0, 0, 0.8F}, 1);
  add_quad(scene, {-0.5F, -0.7F, -0.5F}, {0, 0, 1}, {1, 0, 0}, 1);
  EnvironmentMap map{8, 4, std::vector<glm::vec3>(32, glm::vec3(0.2F, 0.4F, 0.6F)), 0};
  map.radiance[11] = map.radiance[20] = glm::vec3(6);
  scene.environment = map;
  return scene;
}

TEST(Independent, LightSamplesBringWhatPathsFind) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const Scene scene = lit_from_all_sides(c.material);
    Options options = one_pixel(2, 150'000);
    const Seen sampled = seen_from(scene, c.eye, {0.1F, 0, 0.1F}, options);
    options.sample_lights = false;
    options.seed = 2;
    const Seen found = seen_from(scene, c.eye, {0.1F, 0, 0.1F}, options);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(sampled.mean[k], found.mean[k], kSigmas * std::hypot(sampled.error[k], found.error[k]));
      EXPECT_LT(found.error[k], 0.01 * found.mean[k]);
    }
  }
}

// A lamp of 800 triangles, half of which are dark by a texture, is the same as one of two.
TEST(Independent, SamplesLampsOfManyTriangles) {
  LitFloor lit = lit_floor(0.8F, 3, 1, 2);
  Scene scene = lit.scene;
  scene.triangles.resize(2);  // the floor
  constexpr int kParts = 20;
  for (int i = 0; i < kParts * kParts; ++i) {
    const float step = 1.0F / kParts;
    const float x = step * static_cast<float>(i % kParts) - 0.5F,
                z = step * static_cast<float>(i / kParts) - 0.5F;
    const std::size_t first = scene.triangles.size();
    add_quad(scene, {x, 2, z}, {step, 0, 0}, {0, 0, step}, 1);
    const glm::vec2 uv(x < -0.01F ? 0.25F : 0.75F, 0.5F);
    for (std::size_t k = first; k < first + 2; ++k) scene.triangles[k].uv.fill(uv);
  }
  Texture texture = add_image(scene, 2, {{255, 255, 255, 255}, {0, 0, 0, 255}});
  texture.is_nearest = true;
  scene.materials[1].texture(TextureSlot::emission) = texture;
  expect_about(seen_from(scene, {3, 1, 3}, {0, 0, 0.25F}, one_pixel(1, 20'000)),
               glm::dvec3(0.5 * lit.radiance(0, 0.25)));
}

}  // namespace
}  // namespace qtrace::independent
