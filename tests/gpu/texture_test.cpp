// Textures as the shaders read them, against a look-up in double precision; and what they do to a surface.
#include "engine/core/check.h"
#include "engine/device_scene/scene_buffers.h"
#include "engine/device_scene/scene_features.h"
#include "tests/support/render.h"
#include "tests/support/statistics.h"
#include "tests/support/textured_quad.h"

#include <gtest/gtest.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <cmath>

namespace qtrace::test {
namespace {

constexpr int kSize = 48;
constexpr double kHalfRounding = 5e-4;  // of 16-bit floats, relative to 1

RenderSettings settings_of(int size) {
  RenderSettings settings;
  settings.width = settings.height = size;
  settings.sampler = Sampler::bsdf;
  settings.max_bounces = 1;
  return settings;
}

FirstHitImage look_at_quad(const Scene& scene) {
  return Tracer(device(), scene, settings_of(kSize)).first_hit();
}

// (x, y) of a pixel's centre.
glm::dvec2 place_of(int pixel) { return {(pixel % kSize + 0.5) / kSize, 1 - (pixel / kSize + 0.5) / kSize}; }

std::int64_t wrapped(std::int64_t i, std::int64_t n, Wrap wrap) {
  if (wrap == Wrap::clamp_to_edge) return std::clamp<std::int64_t>(i, 0, n - 1);
  const std::int64_t period = wrap == Wrap::repeat ? n : 2 * n;
  const std::int64_t m = ((i % period) + period) % period;
  return m < n ? m : 2 * n - 1 - m;
}

double srgb_to_linear(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }

glm::dvec4 texel(const TextureImage& image, const Texture& use, bool srgb, std::int64_t x, std::int64_t y) {
  const auto column = static_cast<std::size_t>(wrapped(x, image.width, use.wrap_u));
  const auto row = static_cast<std::size_t>(wrapped(y, image.height, use.wrap_v));
  const auto& t = image.texels[row * image.width + column];
  const auto colour = [&](std::size_t c) { return srgb ? srgb_to_linear(t[c] / 65535.0) : t[c] / 65535.0; };
  return {colour(0), colour(1), colour(2), t[3] / 65535.0};
}

glm::dvec4 look_up(const TextureImage& image, const Texture& use, bool srgb, const glm::dvec2& uv) {
  const glm::dvec2 p =
      glm::dmat3x2(use.image_from_uv) * glm::dvec3(uv, 1) * glm::dvec2(image.width, image.height);
  const auto whole = [](double v) { return static_cast<std::int64_t>(std::floor(v)); };
  if (use.is_nearest) return texel(image, use, srgb, whole(p.x), whole(p.y));
  const std::int64_t x = whole(p.x - 0.5), y = whole(p.y - 0.5);
  const double a = p.x - 0.5 - static_cast<double>(x), b = p.y - 0.5 - static_cast<double>(y);
  const auto at = [&](std::int64_t dx, std::int64_t dy) { return texel(image, use, srgb, x + dx, y + dy); };
  return glm::mix(glm::mix(at(0, 0), at(1, 0), a), glm::mix(at(0, 1), at(1, 1), a), b);
}

struct Case {
  const char* name;
  std::uint32_t width, height;
  Texture use;
};

std::vector<Case> cases() {
  const glm::mat3x2 turned(2.2F, 1.1F, -0.7F, 3.1F, -0.4F, 0.3F);
  std::vector<Case> all{
      {"plain", 4, 4, {}}, {"one texel", 1, 1, {}}, {"odd sides", 5, 3, {}}, {"a row", 7, 1, {}}};
  all.push_back({"second set", 4, 4, {.uv_set = 1}});
  all.push_back({"repeated", 4, 5, {.image_from_uv = turned}});
  all.push_back(
      {"mirrored",
       4,
       5,
       {.wrap_u = Wrap::mirrored_repeat, .wrap_v = Wrap::mirrored_repeat, .image_from_uv = turned}});
  all.push_back({"clamped",
                 4,
                 5,
                 {.wrap_u = Wrap::clamp_to_edge, .wrap_v = Wrap::clamp_to_edge, .image_from_uv = turned}});
  all.push_back({"mixed",
                 4,
                 5,
                 {.wrap_u = Wrap::clamp_to_edge, .wrap_v = Wrap::mirrored_repeat, .image_from_uv = turned}});
  all.push_back(
      {"nearest", 4, 5, {.wrap_v = Wrap::mirrored_repeat, .is_nearest = true, .image_from_uv = turned}});
  return all;
}

// Nearest texels jump where single precision may stand on the other side.
bool is_near_a_jump(const Case& c, const glm::dvec2& uv) {
  const glm::dvec2 p = glm::dmat3x2(c.use.image_from_uv) * glm::dvec3(uv, 1) * glm::dvec2(c.width, c.height);
  const glm::dvec2 off = glm::abs(p - glm::round(p));
  return c.use.is_nearest && std::min(off.x, off.y) < 1e-4;
}

TEST(Textures, BaseColoursAreThoseOfALookUpInDoublePrecision) {
  std::uint32_t seed = 1;
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    Scene scene = textured_quad();
    const TextureImage image = random_image(c.width, c.height, seed++);
    set_texture(scene, TextureSlot::base_color, image, c.use);
    scene.materials[0].base_color = {1, 0.5F, 0.25F};
    const FirstHitImage seen = look_at_quad(scene);
    for (int i = 0; i < kSize * kSize; ++i) {
      const glm::dvec2 p = place_of(i);
      const glm::dvec2 uv = c.use.uv_set == 1 ? glm::dvec2(p.y, p.x) : p;
      if (is_near_a_jump(c, uv)) continue;
      const glm::dvec3 truth = glm::dvec3(look_up(image, c.use, true, uv)) * glm::dvec3(1, 0.5, 0.25);
      const glm::dvec3 error = glm::abs(glm::dvec3(seen.albedo[static_cast<std::size_t>(i)]) - truth);
      ASSERT_LT(std::max({error.x, error.y, error.z}), kHalfRounding) << "pixel " << i;
    }
  }
}

TEST(Textures, EmissionIsTheFactorTimesTheTexture) {
  Scene scene = textured_quad(glm::vec3(3, 1, 10));
  const TextureImage image = random_image(6, 4, 9);
  set_texture(scene, TextureSlot::emission, image);
  const FirstHitImage seen = look_at_quad(scene);
  for (int i = 0; i < kSize * kSize; ++i) {
    const glm::dvec3 truth =
        glm::dvec3(look_up(image, {}, true, place_of(i))) * glm::dvec3(scene.materials[0].emission);
    const glm::dvec3 error = glm::abs(glm::dvec3(seen.emission[static_cast<std::size_t>(i)]) - truth);
    ASSERT_LT(std::max({error.x, error.y, error.z}), 10 * kHalfRounding) << "pixel " << i;
  }
}

TEST(Textures, VertexColoursAreInterpolatedAndMultiplyTheBaseColour) {
  Scene scene = textured_quad();
  for (const Triangle& t : scene.triangles) {
    for (std::size_t i = 0; i < 3; ++i)
      scene.attributes[t.attributes].color[i] = {t.position[i].x, t.position[i].y, 0.5F, 1};
  }
  scene.materials[0].base_color = {0.5F, 1, 1};
  const FirstHitImage seen = look_at_quad(scene);
  for (int i = 0; i < kSize * kSize; ++i) {
    const glm::vec3 albedo = seen.albedo[static_cast<std::size_t>(i)];
    ASSERT_NEAR(albedo.r, 0.5 * place_of(i).x, 1e-5);
    ASSERT_NEAR(albedo.g, place_of(i).y, 1e-5);
    ASSERT_NEAR(albedo.b, 0.5, 1e-5);
  }
}

// A normal of the texture's own space: x along growing u, y up in the image.
glm::dvec3 seen_normal(const glm::vec3& texel, float scale, bool from_behind) {
  Scene scene = textured_quad();
  set_texture(scene, TextureSlot::normal, constant_image(glm::vec4(0.5F * texel + 0.5F, 1)));
  scene.materials[0].normal_scale = scale;
  if (from_behind) {
    scene.camera = look_at({0.5F, 0.5F, -1}, {0.5F, 0.5F, 0}, 1);
    scene.camera.film_height = 1;
  }
  return look_at_quad(scene).normal[kSize * kSize / 2 + kSize / 2];
}

TEST(Textures, NormalsTurnTheShadingNormal) {
  const glm::vec3 bent = glm::normalize(glm::vec3(0.3F, 0.2F, 0.8F));
  const glm::dvec3 front = seen_normal(bent, 1, false);
  // Up in the image is -y here (textured_quad.h).
  EXPECT_LT(glm::length(front - glm::dvec3(bent.x, -bent.y, bent.z)), 1e-3);
  const glm::dvec3 scaled = seen_normal(bent, 0.5F, false);
  const glm::dvec3 half = glm::normalize(glm::dvec3(0.5F * bent.x, -0.5F * bent.y, bent.z));
  EXPECT_LT(glm::length(scaled - half), 1e-3);
  // The back face has the whole normal reversed.
  const glm::dvec3 back = seen_normal(bent, 1, true);
  EXPECT_LT(glm::length(back + glm::dvec3(bent.x, -bent.y, bent.z)), 1e-3);
}

// Keller 2017: the mirrored ray of a viewer at (0, 0, 1) would go below for normals at more than 45 degrees.
TEST(Textures, NormalsStopWhereTheMirroredRayWouldGoBelow) {
  const glm::vec3 steep = glm::normalize(glm::vec3(3, 0, 1));
  const glm::dvec3 n = seen_normal(steep, 1, false);
  EXPECT_NEAR(glm::length(n), 1, 1e-5);
  EXPECT_NEAR(n.y, 0, 1e-4);
  EXPECT_NEAR(2 * n.z * n.z - 1, 1e-3, 1e-3);  // z of the mirrored ray
  EXPECT_GT(n.x, 0.7);
}

// Under a constant sky a Lambert surface shows its albedo, wherever its normal points: what is lost is what
// the normal sends below the surface, and nothing is won.
TEST(Textures, BentNormalsMakeNoEnergy) {
  for (const float tilt : {0.0F, 0.5F, 1.0F, 3.0F}) {
    Scene scene = textured_quad();
    set_texture(scene, TextureSlot::normal,
                constant_image(glm::vec4(0.5F * glm::normalize(glm::vec3(tilt, 0, 1)) + 0.5F, 1)));
    RenderSettings settings = settings_of(16);
    settings.environment = {1, 1, 1};
    const Rendering r = render(scene, settings, 64);
    const Estimate mean = block_estimate(r.image, 0, 0, 16);
    // Of a cosine lobe about a normal at angle a, (1 + cos a) / 2 is above a plane: a view factor.
    const double angle = std::min(std::atan(double{tilt}), 0.5 * std::acos(1e-3));
    const double truth = (1 + std::cos(angle)) / 2;
    EXPECT_LT(std::abs(mean.mean - truth), 4 * std::sqrt(mean.variance) + 2e-3) << tilt;
    EXPECT_LE(mean.mean, 1 + 1e-6);
  }
}

// The picture of a lamp on the floor, by light samples and by paths; of a lamp with a dark half and a corner
// that is lit.
TEST(Textures, LampsLightAlikeByPathsAndByLightSamples) {
  Scene scene = lit_floor(0.8F, 40, 2, 1).scene;
  TextureImage image{"lamp", 4, 4, std::vector<TextureImage::Texel>(16, {0, 0, 0, 65535})};
  image.texels[0] = {65535, 30000, 0, 65535};
  image.texels[6] = {0, 65535, 65535, 65535};
  std::uint32_t lamp = 0;
  while (scene.materials[lamp].emission == glm::vec3(0)) ++lamp;
  scene.images.push_back(image);
  scene.materials[lamp].texture(TextureSlot::emission) = Texture{};
  RenderSettings settings = settings_of(16);
  std::vector<Estimate> means;
  for (const Nee nee : {Nee::none, Nee::one_ray, Nee::two_ray}) {
    settings.nee = nee;
    means.push_back(block_estimate(render(scene, settings, 1024).image, 0, 0, 16));
  }
  EXPECT_GT(means[0].mean, 0.05);
  EXPECT_LT(z_score(means[0], means[1]), 4) << means[0].mean << " " << means[1].mean;
  EXPECT_LT(z_score(means[0], means[2]), 4) << means[0].mean << " " << means[2].mean;
  EXPECT_LT(means[1].variance, 0.5 * means[0].variance);
}

TEST(Textures, ABlackOneMakesNoLamp) {
  Scene scene = lit_floor(0.8F, 40, 2, 1).scene;
  std::uint32_t lamp = 0;
  while (scene.materials[lamp].emission == glm::vec3(0)) ++lamp;
  scene.images.push_back(constant_image(glm::vec4(0, 0, 0, 1)));
  scene.materials[lamp].texture(TextureSlot::emission) = Texture{};
  EXPECT_EQ(gpu::find_features(scene).lights, 0U);
  RenderSettings settings = settings_of(16);
  settings.nee = Nee::one_ray;
  for (const glm::dvec3& pixel : render(scene, settings, 4).image.mean) EXPECT_EQ(pixel, glm::dvec3(0));
}

// Roughness and metallic from a texture are as from factors; specular strength and colour likewise.
TEST(Textures, FactorsFromATextureAreAsFromTheMaterial) {
  const auto shown = [](const Scene& scene) {
    RenderSettings settings = settings_of(16);
    settings.environment = {1, 2, 3};
    return render(scene, settings, 16).image.mean;
  };
  Scene plain = textured_quad();
  qtrace::Material& m = plain.materials[0];
  m.base_color = {0.8F, 0.5F, 0.2F};
  m.metallic = 0.4F;
  m.roughness = 0.5F;
  m.specular = 0.6F;
  m.specular_color = {1, 0.5F, 0.25F};
  Scene textured = plain;
  qtrace::Material& t = textured.materials[0];
  t.metallic = t.roughness = t.specular = 1;
  t.specular_color = glm::vec3(1);
  set_texture(textured, TextureSlot::metallic_roughness, constant_image({0.9F, 0.5F, 0.4F, 0.1F}));
  set_texture(textured, TextureSlot::specular, constant_image({0.1F, 0.2F, 0.3F, 0.6F}));
  // sRGB of 1, 0.5 and 0.25.
  set_texture(textured, TextureSlot::specular_color, constant_image({1, 0.735357F, 0.537099F, 0.1F}));
  const auto a = shown(plain), b = shown(textured);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LT(glm::length(a[i] - b[i]), 2e-3 * glm::length(a[i])) << i;
  }
}

// An image that is read as colour, as numbers and as normals stands there three times.
TEST(Textures, WithMoreTexelsThanTheDeviceHoldsAreRefused) {
  device();
  constexpr std::uint32_t kWidth = 32768;
  const std::size_t most =
      gpu::most_buffer_bytes(gpu::only_fetched(gpu::Texels::half4)) / sizeof(gpu::HalfTexel);
  const auto height = static_cast<std::uint32_t>(most / 3 / kWidth + 1);
  if (height > 4096) GTEST_SKIP() << "this device holds more than the test has memory for";
  Scene scene = textured_quad();
  set_texture(scene, TextureSlot::base_color, {"wide", kWidth, height, {}});
  scene.images[0].texels.resize(std::size_t{kWidth} * height);
  for (const TextureSlot slot : {TextureSlot::metallic_roughness, TextureSlot::transmission}) {
    scene.materials[0].texture(slot) = scene.materials[0].texture(TextureSlot::base_color);
  }
  gpu::check_texels(scene);  // colours and numbers: twice
  scene.materials[0].texture(TextureSlot::normal) = scene.materials[0].texture(TextureSlot::base_color);
  try {
    gpu::check_texels(scene);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("the texels of all textures"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace qtrace::test
