// Clearcoats and unlit surfaces against closed forms.
#include "tests/independent/small_scenes.h"

namespace qtrace::independent {
namespace {

const glm::dvec3 kToEye = glm::normalize(glm::dvec3(0.5, 0.3, 0.6));  // from a wall

Material coated(Material material, float roughness) {
  material.clearcoat = 0.8F;
  material.clearcoat_roughness = roughness;
  return material;
}
double share(double cosine) { return 0.8 * (0.04 + 0.96 * std::pow(1 - cosine, 5)); }

Seen seen_at(const Scene& scene, const glm::dvec3& to_eye, int bounces, int samples) {
  Options options = one_pixel(bounces, samples);
  options.environment = {1, 2, 3};
  return seen_from(scene, glm::vec3(to_eye), glm::vec3(0), options);
}

TEST(Independent, CoatsWhatScatters) {
  const Scene scene = wall(coated(lambert(glm::vec3(0.5F)), 0));
  const double coat = share(kToEye.z);
  expect_about(seen_at(scene, kToEye, 1, 40'000), (coat + (1 - coat) * 0.5) * glm::dvec3(1, 2, 3));
}

TEST(Independent, CoatsWhatEmits) {
  const Scene scene = wall(coated(emitter({1, 2, 3}), 0.5F));
  expect_near(seen_at(scene, kToEye, 0, 1).mean, (1 - share(kToEye.z)) * glm::dvec3(1, 2, 3));
}

// See Independent.RoughestLobesKeepAllButTheLogarithmOfTwo.
TEST(Independent, CoatsWithARoughLobe) {
  const Scene scene = wall(coated(lambert(glm::vec3(0)), 1));
  expect_about(seen_at(scene, {0, 0, 1}, 1, 200'000), 0.8 * 0.04 * (1 - std::log(2)) * glm::dvec3(1, 2, 3));
}

// The coat keeps the mesh's normal where only the base has a texture of normals, and the other way round.
TEST(Independent, CoatHasANormalOfItsOwn) {
  const Rgba value{180, 128, 220, 255};
  const glm::dvec3 leaning =
      glm::normalize(glm::dvec3(2 * 180 / 255.0 - 1, 2 * 128 / 255.0 - 1, 2 * 220 / 255.0 - 1));
  const glm::dvec3 straight(0, 0, 1), to_sun = glm::normalize(glm::dvec3(0.2, 0.1, 0.9));
  for (const bool on_coat : {true, false}) {
    SCOPED_TRACE(on_coat);
    Scene scene = wall(coated(lambert(glm::vec3(0.5F)), 0));  // smooth: no sample of the sun meets it
    scene.lights.push_back(sun(glm::vec3(-to_sun), glm::vec3(2)));
    TriangleAttributes attributes;
    attributes.tangent.fill(glm::vec4(1, 0, 0, 1));
    set_attributes(scene, attributes);
    scene.materials[0].texture(on_coat ? TextureSlot::clearcoat_normal : TextureSlot::normal) =
        add_image(scene, 1, {value});
    const double coat = share(glm::dot(kToEye, on_coat ? leaning : straight));
    const double base = 0.5 / M_PI * 2 * glm::dot(to_sun, on_coat ? straight : leaning);
    const Seen found = seen_from(scene, glm::vec3(kToEye), glm::vec3(0), one_pixel(1));
    expect_near(found.mean, glm::dvec3((1 - coat) * base));
  }
}

TEST(Independent, CoatsWhatTransmits) {
  Scene scene = wall(coated(glass(0, true), 0));
  add_wall(scene, -1, emitter(glm::vec3(1)));
  const double f = 0.04 + 0.96 * std::pow(1 - kToEye.z, 5), coat = share(kToEye.z);
  const Seen found = seen_from(scene, glm::vec3(0.5 * kToEye), glm::vec3(0), one_pixel(1, 20'000));
  expect_about(found, glm::dvec3((1 - coat) * (1 - f)));
}

TEST(Independent, ShowsUnlitSurfacesFromBothSides) {
  Material material = coated(unlit({0.2F, 0.4F, 0.6F}), 0);
  material.emission = glm::vec3(7);
  const Scene scene = wall(material);
  for (const double side : {1.0, -1.0}) {
    expect_near(seen_at(scene, side * kToEye, 3, 1).mean, {0.2, 0.4, 0.6});
  }
}

// It lights what paths find it from, but no light sample asks for it.
TEST(Independent, UnlitSurfacesLightWhatIsBelow) {
  LitFloor lit = lit_floor(0.8F, 1, 4, 1);
  lit.scene.materials[1] = unlit(glm::vec3(1));
  lit.scene.materials[1].emission = glm::vec3(7);  // which is not its radiance
  for (const bool sample_lights : {true, false}) {
    Options options = one_pixel(1, 40'000);
    options.sample_lights = sample_lights;
    expect_about(seen_from(lit.scene, {3, 0.5F, 3}, {0.5F, 0, 0.25F}, options),
                 glm::dvec3(lit.radiance(0.5, 0.25)));
  }
}

}  // namespace
}  // namespace qtrace::independent
