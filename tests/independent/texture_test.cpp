// The independent tracer's textures against values from their definitions.
#include "tests/independent/texture.h"
#include "tests/independent/small_scenes.h"

#include <functional>

namespace qtrace::independent {
namespace {

// IEC 61966-2-1 of values above its linear part.
double decoded(int byte) { return std::pow((byte / 255.0 + 0.055) / 1.055, 2.4); }

TEST(Independent, DecodesTheValuesOfSrgb) {
  Scene scene;
  const Texture texture = add_image(scene, 2, {{0, 10, 11, 128}, {188, 255, 128, 255}});
  const glm::dvec4 left = look_up(scene, texture, TextureSlot::base_color, {0.25, 0.5});
  const glm::dvec4 right = look_up(scene, texture, TextureSlot::base_color, {0.75, 0.5});
  EXPECT_EQ(left.r, 0);
  EXPECT_NEAR(left.g, 10 / 255.0 / 12.92, 1e-15);  // 0.0392 is in the linear part, 0.0431 is not
  EXPECT_NEAR(left.b, 0.003346535763899161, 1e-15);
  EXPECT_NEAR(left.a, 128 / 255.0, 1e-15);  // linear
  EXPECT_NEAR(right.r, 0.502886458033, 1e-11);
  EXPECT_NEAR(right.g, 1, 1e-15);
  EXPECT_NEAR(right.b, 0.215860500114, 1e-11);
  EXPECT_NEAR(look_up(scene, texture, TextureSlot::normal, {0.25, 0.5}).g, 10 / 255.0, 1e-15);
  // Between centres, what was decoded is mixed.
  EXPECT_NEAR(look_up(scene, texture, TextureSlot::emission, {0.4, 0.5}).r, 0.3 * right.r, 1e-14);
}

// Image of 4 x 2 whose red is 10 times the column and whose green is 100 times the row.
Texture numbered(Scene& scene) {
  std::vector<Rgba> texels;
  for (int i = 0; i < 8; ++i) {
    texels.push_back(
        {static_cast<std::uint8_t>(10 * (i % 4)), static_cast<std::uint8_t>(100 * (i / 4)), 0, 0});
  }
  return add_image(scene, 4, texels);
}

TEST(Independent, WrapsTexturesThreeWays) {
  Scene scene;
  Texture texture = numbered(scene);
  const auto column_at = [&](Wrap wrap, double u, bool is_nearest) {
    texture.wrap_u = wrap;
    texture.wrap_v = Wrap::clamp_to_edge;
    texture.is_nearest = is_nearest;
    return look_up(scene, texture, TextureSlot::normal, {u, 0.1}).r * 255 / 10;
  };
  struct Case {
    double u, repeated, mirrored, clamped;
  };
  for (const Case& c : {Case{0.3, 1, 1, 1}, Case{1.1, 0, 3, 3}, Case{-0.1, 3, 0, 0}, Case{-0.6, 1, 2, 0},
                        Case{2.3, 1, 1, 3}, Case{-1.1, 3, 3, 0}}) {
    SCOPED_TRACE(c.u);
    EXPECT_NEAR(column_at(Wrap::repeat, c.u, true), c.repeated, 1e-12);
    EXPECT_NEAR(column_at(Wrap::mirrored_repeat, c.u, true), c.mirrored, 1e-12);
    EXPECT_NEAR(column_at(Wrap::clamp_to_edge, c.u, true), c.clamped, 1e-12);
  }
  // Columns have their centres at 1/8, 3/8, 5/8 and 7/8.
  EXPECT_NEAR(column_at(Wrap::repeat, 0.45, false), 1.3, 1e-12);
  EXPECT_NEAR(column_at(Wrap::repeat, 1.0, false), 1.5, 1e-12);  // between the last and the first
  EXPECT_NEAR(column_at(Wrap::mirrored_repeat, 1.0, false), 3, 1e-12);
  EXPECT_NEAR(column_at(Wrap::clamp_to_edge, 1.0, false), 3, 1e-12);
}

TEST(Independent, TransformsCoordinatesOfTextures) {
  Scene scene;
  Texture texture = numbered(scene);
  texture.image_from_uv = {0, 1, 0.5F, 0, 0.25F, -0.5F};  // (u, v) becomes (v / 2 + 1/4, u - 1/2)
  const glm::dvec4 found = look_up(scene, texture, TextureSlot::normal, {0.85, 0.4});  // (0.45, 0.35)
  EXPECT_NEAR(found.r * 255, 13, 1e-5);
  EXPECT_NEAR(found.g * 255, 20, 1e-5);
}

// The wall's UV map grows to the right and upwards, and v falls in the image from its first row.
TEST(Independent, ShowsTexturesWhereTheUvMapSays) {
  Scene scene = wall(emitter({2, 3, 4}));
  Texture texture = add_image(scene, 2, {{255, 0, 0, 0}, {0, 255, 0, 0}, {0, 0, 255, 0}, {128, 128, 128, 0}});
  texture.is_nearest = true;
  scene.materials[0].texture(TextureSlot::emission) = texture;
  const auto at = [&](float x, float y) { return seen_from(scene, {x, y, 3}, {x, y, 0}, one_pixel(0)).mean; };
  expect_near(at(-0.4F, -0.4F), {2, 0, 0});
  expect_near(at(0.4F, -0.4F), {0, 3, 0});
  expect_near(at(-0.4F, 0.4F), {0, 0, 4});
  expect_near(at(0.4F, 0.4F), decoded(128) * glm::dvec3(2, 3, 4));
  // The second set of coordinates has its own place.
  TriangleAttributes attributes;
  attributes.uv1.fill(glm::vec2(0.75F, 0.25F));
  set_attributes(scene, attributes);
  scene.materials[0].texture(TextureSlot::emission)->uv_set = 1;
  expect_near(at(-0.4F, -0.4F), {0, 3, 0});
}

// A texture of one texel is the same as a factor, in its own channels alone.
TEST(Independent, MultipliesEveryFactorByItsTexture) {
  Material start = glass(0.6F, true);
  start.base_color = {0.9F, 0.8F, 0.7F};
  start.metallic = 0.4F;
  start.transmission = 0.6F;
  start.specular = 0.8F;
  start.specular_color = {1.5F, 1.2F, 0.9F};
  start.emission = {0.3F, 0.2F, 0.1F};
  start.clearcoat = 0.7F;
  start.clearcoat_roughness = 0.5F;
  start.ior = 2;
  const auto linear = [](int byte) { return static_cast<float>(byte / 255.0); };
  const glm::vec3 color(static_cast<float>(decoded(200)), static_cast<float>(decoded(150)),
                        static_cast<float>(decoded(100)));
  const float r = linear(200), g = linear(150), b = linear(100), a = linear(50);
  struct Case {
    TextureSlot slot;
    std::function<void(Material&)> multiply;
  };
  const std::vector<Case> cases{
      {TextureSlot::base_color, [&](Material& m) { m.base_color *= color; }},
      {TextureSlot::metallic_roughness, [&](Material& m) { m.roughness *= g, m.metallic *= b; }},
      {TextureSlot::emission, [&](Material& m) { m.emission *= color; }},
      {TextureSlot::specular, [&](Material& m) { m.specular *= a; }},
      {TextureSlot::specular_color, [&](Material& m) { m.specular_color *= color; }},
      {TextureSlot::transmission, [&](Material& m) { m.transmission *= r; }},
      {TextureSlot::clearcoat, [&](Material& m) { m.clearcoat *= r; }},
      {TextureSlot::clearcoat_roughness, [&](Material& m) { m.clearcoat_roughness *= g; }},
  };
  const auto found = [](const Scene& scene) {
    Options options = one_pixel(2, 500);
    options.environment = {1, 2, 3};
    return seen_from(scene, {1, 1, 2}, {0.1F, 0.2F, 0}, options).mean;
  };
  const auto scene_of = [](const Material& material) {
    Scene scene = wall(material);
    add_wall(scene, -1, emitter({5, 5, 5}));
    add_wall(scene, 3, lambert({0.5F, 0.5F, 0.5F}, {0.2F, 0.2F, 0.2F}));
    scene.lights.push_back(sun({1, 0.2F, -1}, {3, 3, 3}));
    return scene;
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(static_cast<int>(c.slot));
    Material by_factor = start;
    c.multiply(by_factor);
    Scene textured = scene_of(start);
    textured.materials[0].texture(c.slot) = add_image(textured, 1, {{200, 150, 100, 50}});
    const glm::dvec3 expected = found(scene_of(by_factor));
    expect_near(found(textured), expected, 1e-4);
    EXPECT_GT(glm::length(found(scene_of(start)) - expected), 1e-3) << "the scene does not show this factor";
  }
}

TEST(Independent, InterpolatesColorsOfVertices) {
  Scene scene = wall(unlit({0.5F, 1, 1}));
  TriangleAttributes attributes;
  attributes.color = {glm::vec4(1, 0, 0, 1), glm::vec4(0, 1, 0, 1), glm::vec4(0, 0, 1, 1)};
  set_attributes(scene, attributes);
  scene.materials[0].texture(TextureSlot::base_color) = add_image(scene, 1, {{255, 255, 128, 255}});
  // The first triangle's corners are (-1, -1), (1, -1) and (1, 1).
  const glm::dvec3 weights(0.2, 0.5, 0.3);
  const glm::vec3 place(-0.2F + 0.5F + 0.3F, -0.2F - 0.5F + 0.3F, 0);
  const Seen found = seen_from(scene, place + glm::vec3(0, 0, 2), place, one_pixel(0));
  expect_near(found.mean, weights * glm::dvec3(0.5, 1, decoded(128)));
}

// The left half of a lamp, which is half of its light by symmetry, whatever finds it.
TEST(Independent, SamplesLampsWithTextures) {
  LitFloor lit = lit_floor(0.8F, 3, 1, 2);
  Texture texture = add_image(lit.scene, 2, {{255, 255, 255, 255}, {0, 0, 0, 255}});
  texture.is_nearest = true;
  lit.scene.materials[1].texture(TextureSlot::emission) = texture;
  for (const bool sample_lights : {true, false}) {
    SCOPED_TRACE(sample_lights);
    Options options = one_pixel(1, sample_lights ? 20'000 : 200'000);
    options.sample_lights = sample_lights;
    expect_about(seen_from(lit.scene, {3, 1, 3}, {0, 0, 0.25F}, options),
                 glm::dvec3(0.5 * lit.radiance(0, 0.25)), 0.02);
  }
}

}  // namespace
}  // namespace qtrace::independent
