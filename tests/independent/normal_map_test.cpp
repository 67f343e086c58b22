// The independent tracer's textures of normals against closed forms.
#include "tests/independent/shading_normal.h"
#include "tests/independent/small_scenes.h"

#include <functional>
#include <random>

namespace qtrace::independent {
namespace {

const glm::vec3 kToSun = glm::normalize(glm::vec3(0.3F, 0.4F, 0.8F));

// A Lambert wall in the sun, whose tangent is +x.
Scene mapped_wall(const Rgba& value, float scale, float w) {
  Scene scene = wall(lambert(glm::vec3(0.5F)));
  scene.lights.push_back(sun(-kToSun, glm::vec3(2)));
  TriangleAttributes attributes;
  // Only what is perpendicular to the normal counts.
  attributes.tangent.fill(glm::vec4(glm::normalize(glm::vec3(1, 0, 0.5F)), w));
  set_attributes(scene, attributes);
  scene.materials[0].texture(TextureSlot::normal) = add_image(scene, 1, {value});
  scene.materials[0].normal_scale = scale;
  return scene;
}

TEST(Independent, ShadesByNormalsFromTextures) {
  const Rgba value{160, 100, 230, 255};
  for (const float scale : {1.0F, 0.5F, -1.0F}) {
    for (const float w : {1.0F, -1.0F}) {
      SCOPED_TRACE(testing::Message() << scale << ' ' << w);
      // B = w cross(z, x) = w y.
      const glm::dvec3 n = glm::normalize(
          glm::dvec3(scale * (2 * 160 / 255.0 - 1), w * scale * (2 * 100 / 255.0 - 1), 2 * 230 / 255.0 - 1));
      const double expected = 0.5 / M_PI * 2 * glm::dot(n, glm::dvec3(kToSun));
      const Scene scene = mapped_wall(value, scale, w);
      expect_near(seen_from(scene, {0, 0, 3}, {0, 0.1F, 0}, one_pixel(1)).mean, glm::dvec3(expected));
      // The back shows the same bumps: there, all of the normal is turned.
      Scene behind = scene;
      behind.lights[0] = sun(kToSun, glm::vec3(2));
      expect_near(seen_from(behind, {0, 0, -3}, {0, 0.1F, 0}, one_pixel(1)).mean, glm::dvec3(expected));
    }
  }
}

TEST(Independent, ScattersOnlyWhereNormalAndFaceAgree) {
  const Rgba to_the_right{230, 128, 180, 255};
  Scene base = mapped_wall(to_the_right, 1, 1);
  Scene coat = base;
  Material& coated = coat.materials[0];
  coated = lambert(glm::vec3(0));
  coated.clearcoat = coated.clearcoat_roughness = 1;
  coated.texture(TextureSlot::clearcoat_normal) = base.materials[0].texture(TextureSlot::normal);
  Scene thin = base;
  thin.materials[0] = glass(0.8F, true);
  thin.materials[0].texture(TextureSlot::normal) = base.materials[0].texture(TextureSlot::normal);
  for (Scene& scene : {std::ref(base), std::ref(coat), std::ref(thin)}) {
    const auto seen_under = [&](glm::vec3 to_sun) {
      scene.lights[0] = sun(-to_sun, glm::vec3(2));
      return seen_from(scene, {0, 0, 3}, {0, 0.1F, 0}, one_pixel(1)).mean.x;
    };
    EXPECT_EQ(seen_under({-1, 0, 0.5F}), 0);  // behind the bump, and before the wall
    EXPECT_EQ(seen_under({1, 0, -0.2F}), 0);  // before the bump, and behind the wall
    EXPECT_GT(seen_under({1, 0, 0.2F}), 1e-3);
    EXPECT_EQ(seen_under({-1, 0, -0.5F}) > 0, &scene == &thin);
  }
}

TEST(Independent, TurnsNormalsUntilTheirMirrorLeavesTheSurface) {
  std::mt19937 bits(5);
  std::normal_distribution<double> normal;
  const auto direction = [&] { return glm::normalize(glm::dvec3(normal(bits), normal(bits), normal(bits))); };
  const glm::dvec3 face(0, 0, 1);
  int kept = 0, flipped = 0, lifted = 0;
  for (int i = 0; i < 2000; ++i) {
    glm::dvec3 eye = direction();
    eye.z = std::abs(eye.z);
    const glm::dvec3 n = direction();
    const glm::dvec3 before = 2 * glm::dot(n, eye) * n - eye;
    const glm::dvec3 found = adapted_normal(n, face, eye);
    const glm::dvec3 after = 2 * glm::dot(found, eye) * found - eye;
    EXPECT_NEAR(glm::length(found), 1, 1e-12);
    EXPECT_GT(glm::dot(found, eye), 0);
    if (before.z >= 1e-3) {  // the same mirror, on the eye's side
      expect_near(found, glm::dot(n, eye) > 0 ? n : -n, 1e-9);
      ++(glm::dot(n, eye) > 0 ? kept : flipped);
      continue;
    }
    // Lifted above the surface, in the plane of its direction and the face's normal.
    expect_near(after, glm::normalize(glm::dvec3(before.x, before.y, 1e-3)), 1e-9);
    ++lifted;
  }
  EXPECT_GT(std::min({kept, flipped, lifted}), 100);
}

}  // namespace
}  // namespace qtrace::independent
