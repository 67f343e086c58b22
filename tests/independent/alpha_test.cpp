// Surfaces of which only a part is there, against closed forms.
#include "tests/independent/small_scenes.h"

namespace qtrace::independent {
namespace {

Material blended(Material material, float opacity) {
  material.alpha_mode = AlphaMode::blend;
  material.opacity = opacity;
  return material;
}

TEST(Independent, ShowsTheOpacitysShareOfABlendedSurface) {
  Scene scene = wall(blended(emitter({1, 2, 3}), 0.8F));
  add_wall(scene, -1, emitter(glm::vec3(5)));
  scene.materials[0].texture(TextureSlot::base_color) = add_image(scene, 1, {{1, 2, 3, 128}});
  TriangleAttributes attributes;
  attributes.color.fill(glm::vec4(1, 1, 1, 0.75F));
  set_attributes(scene, attributes);
  const double opacity = 0.8 * 128 / 255 * 0.75;
  const glm::dvec3 expected = opacity * glm::dvec3(1, 2, 3) + (1 - opacity) * 5;
  expect_about(seen_from(scene, {0, 0.1F, 3}, {0, 0.1F, 0}, one_pixel(0, 20'000)), expected);
}

TEST(Independent, ShowsMaskedSurfacesFromTheirCutoffOn) {
  Scene scene = wall(emitter({1, 2, 3}));
  add_wall(scene, -1, emitter(glm::vec3(5)));
  Material& mask = scene.materials[0];
  mask.opacity = 0.5F;
  const auto found = [&] { return seen_from(scene, {0, 0.1F, 3}, {0, 0.1F, 0}, one_pixel(0)).mean; };
  expect_near(found(), {1, 2, 3});  // opaque
  mask.alpha_mode = AlphaMode::mask;
  expect_near(found(), {1, 2, 3});
  mask.alpha_cutoff = 0.5001F;
  expect_near(found(), {5, 5, 5});
}

TEST(Independent, CastsTheOpacitysShareOfAShadow) {
  Scene scene = wall(lambert(glm::vec3(0.5F)));
  scene.lights.push_back(sun({0, 0, -1}, glm::vec3(2)));
  add_wall(scene, 1, blended(lambert(glm::vec3(0)), 0.3F));
  add_wall(scene, 2, blended(lambert(glm::vec3(0)), 0.6F));
  expect_near(seen_from(scene, {0.6F, 0, 0.5F}, {0, 0.1F, 0}, one_pixel(1)).mean,
              glm::dvec3(0.5 / M_PI * 2 * 0.7 * 0.4));
}

// What light samples and paths bring is weighted by the way from the floor, whatever is passed between.
TEST(Independent, LightsAFloorThroughSurfacesThatArePassed) {
  LitFloor lit = lit_floor(0.8F, 3, 1, 2);
  lit.scene.materials[1] = blended(lit.scene.materials[1], 0.4F);  // the lamp
  lit.scene.materials.push_back(blended(emitter(glm::vec3(0)), 0.7F));
  add_quad(lit.scene, {-10, 1.9F, -10}, {20, 0, 0}, {0, 0, 20}, 2);
  for (const bool sample_lights : {true, false}) {
    SCOPED_TRACE(sample_lights);
    Options options = one_pixel(1, sample_lights ? 20'000 : 400'000);
    options.sample_lights = sample_lights;
    expect_about(seen_from(lit.scene, {3, 1, 3}, {0.5F, 0, 0.25F}, options),
                 glm::dvec3(0.4 * 0.3 * lit.radiance(0.5, 0.25)), 0.02);
  }
}

}  // namespace
}  // namespace qtrace::independent
