#include "tests/independent/feature_rooms.h"

#include "engine/scene/analytic.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>

namespace qtrace::independent {
namespace {

enum Part : std::uint32_t { walls, lamp, ball };  // materials

constexpr int kAround = 24;
constexpr int kRows = 12;

glm::vec3 on_sphere(int row, int column) {
  const float polar = std::numbers::pi_v<float> * static_cast<float>(row) / kRows;
  const float azimuth = 2 * std::numbers::pi_v<float> * static_cast<float>(column) / kAround;
  return {std::sin(polar) * std::cos(azimuth), std::cos(polar), -std::sin(polar) * std::sin(azimuth)};
}

// With smooth normals, and coordinates once around and once from pole to pole.
void add_ball(Scene& scene, const glm::vec3& middle, float radius, std::uint32_t material) {
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  const auto first = static_cast<std::uint32_t>(scene.triangles.size());
  const auto add = [&](const std::array<std::array<int, 2>, 3>& corners) {
    Triangle t;
    TriangleAttributes attributes;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [row, column] = corners[i];
      t.normal[i] = on_sphere(row, column);
      t.position[i] = middle + radius * t.normal[i];
      t.uv[i] = {static_cast<float>(column) / kAround, static_cast<float>(row) / kRows};
      const float azimuth = 2 * std::numbers::pi_v<float> * static_cast<float>(column) / kAround;
      attributes.tangent[i] = {-std::sin(azimuth), 0, -std::cos(azimuth), 1};
      attributes.uv1[i] = {t.uv[i].y, t.uv[i].x};
      attributes.color[i] = {0.5F + 0.5F * t.uv[i].x, 1, 1 - 0.5F * t.uv[i].y, 1};
    }
    if (area_of(t) < 1e-9) return;
    t.material = material;
    t.object = object;
    t.attributes = static_cast<std::uint32_t>(scene.attributes.size());
    scene.attributes.push_back(attributes);
    scene.triangles.push_back(t);
  };
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kAround; ++column) {
      add({{{row, column}, {row + 1, column}, {row + 1, column + 1}}});
      add({{{row, column}, {row + 1, column + 1}, {row, column + 1}}});
    }
  }
  scene.objects.push_back({"ball", first, static_cast<std::uint32_t>(scene.triangles.size()) - first, true});
}

Scene room() {
  Scene scene = furnace_box(0.6F, 0);
  scene.materials[walls] = lambert({0.7F, 0.6F, 0.5F});
  scene.materials.push_back(lambert(glm::vec3(0), {6, 5, 4}));
  add_quad(scene, {-0.5F, 0.95F, -0.5F}, {1, 0, 0}, {0, 0, 1}, lamp);  // faces down
  scene.materials.push_back(lambert({0.3F, 0.5F, 0.7F}));
  add_ball(scene, {0.1F, -0.45F, -0.2F}, 0.5F, ball);
  scene.camera = look_at({-0.5F, 0.3F, 0.95F}, {0.1F, -0.3F, -0.3F}, 1.1F);
  return scene;
}

// Without its ceiling, below a sky.
Scene roofless(bool has_lamp) {
  Scene scene = room();
  Scene open;
  open.materials = scene.materials;
  open.camera = scene.camera;
  // The box, but for the wall at the top.
  for (const auto& [corner, u, v] :
       std::vector<std::array<glm::vec3, 3>>{{{{-1, -1, -1}, {0, 0, 2}, {2, 0, 0}}},
                                             {{{-1, -1, -1}, {2, 0, 0}, {0, 2, 0}}},
                                             {{{-1, -1, -1}, {0, 2, 0}, {0, 0, 2}}},
                                             {{{1, -1, -1}, {0, 0, 2}, {0, 2, 0}}}}) {
    add_quad(open, corner, u, v, walls);
  }
  if (has_lamp) add_quad(open, {-0.3F, 0.4F, -0.9F}, {0.3F, 0, 0}, {0, 0, 0.3F}, lamp);
  add_ball(open, {0.1F, -0.45F, -0.2F}, 0.5F, ball);
  EnvironmentMap sky{16, 8, {}, 0.6F};
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0.2F, 1.0F);
  for (int i = 0; i < 16 * 8; ++i)
    sky.radiance.emplace_back(uniform(random), uniform(random), uniform(random));
  sky.radiance[2 * 16 + 9] = {80, 70, 50};
  open.environment = sky;
  return open;
}

TextureImage noise(std::uint32_t width, std::uint32_t height, std::uint32_t seed, std::uint16_t least = 0) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> codes(least, 65535);
  TextureImage image{"noise", width, height, {}};
  const auto code = [&] { return static_cast<std::uint16_t>(codes(random)); };
  for (std::uint32_t i = 0; i < width * height; ++i) image.texels.push_back({code(), code(), code(), code()});
  return image;
}

// Small slopes about straight up.
TextureImage bumps(std::uint32_t side, std::uint32_t seed) {
  TextureImage image = noise(side, side, seed);
  for (auto& texel : image.texels) {
    for (std::size_t c = 0; c < 2; ++c) texel[c] = static_cast<std::uint16_t>(32768 + (texel[c] - 32768) / 2);
    texel[2] = 62000;
  }
  return image;
}

void set(Scene& scene, Part part, TextureSlot slot, TextureImage image, Texture use = {}) {
  use.image = static_cast<std::uint32_t>(scene.images.size());
  scene.images.push_back(std::move(image));
  scene.materials[part].texture(slot) = use;
}

Material glossy(float roughness) {
  Material m;
  m.base_color = {0.8F, 0.7F, 0.6F};
  m.metallic = 0;
  m.roughness = roughness;
  return m;
}

Material glass(float roughness) {
  Material m = glossy(roughness);
  m.base_color = {0.9F, 0.95F, 1};
  m.transmission = 1;
  return m;
}

Material volume(float roughness) {
  Material m = glass(roughness);
  m.is_thin = false;
  m.ior = 1.4F;
  m.attenuation_color = {0.5F, 0.8F, 0.9F};
  m.attenuation_distance = 0.7F;
  return m;
}

Scene with_ball(const Material& material) {
  Scene scene = room();
  scene.materials[ball] = material;
  return scene;
}

Scene textured() {
  Scene scene = with_ball(glossy(1));
  scene.materials[ball].metallic = 1;
  const glm::mat3x2 turned(2.2F, 1.1F, -0.7F, 3.1F, -0.4F, 0.3F);
  set(scene, walls, TextureSlot::base_color, noise(5, 4, 1),
      {.wrap_u = Wrap::mirrored_repeat, .image_from_uv = turned});
  set(scene, lamp, TextureSlot::emission, noise(4, 4, 2), {.is_nearest = true});
  set(scene, ball, TextureSlot::base_color, noise(8, 4, 3), {.uv_set = 1});
  set(scene, ball, TextureSlot::metallic_roughness, noise(6, 3, 4, 20000), {.image_from_uv = turned});
  set(scene, ball, TextureSlot::specular, noise(3, 3, 5));
  set(scene, ball, TextureSlot::specular_color, noise(3, 3, 6), {.wrap_u = Wrap::clamp_to_edge});
  return scene;
}

Scene bumpy() {
  Scene scene = with_ball(glossy(0.4F));
  set(scene, ball, TextureSlot::normal, bumps(16, 7));
  scene.materials[ball].normal_scale = 1.5F;
  return scene;
}

Scene veiled() {
  Scene scene = room();
  scene.materials[ball].alpha_mode = AlphaMode::mask;
  set(scene, ball, TextureSlot::base_color, noise(6, 6, 8));
  scene.materials[lamp].alpha_mode = AlphaMode::blend;
  scene.materials[lamp].opacity = 0.6F;
  Material veil = lambert({0.2F, 0.8F, 0.3F});
  veil.alpha_mode = AlphaMode::blend;
  veil.opacity = 0.5F;
  scene.materials.push_back(veil);
  add_quad(scene, {-0.9F, 0.4F, -0.9F}, {1.2F, 0, 0}, {0, 0, 1.8F}, 3);
  return scene;
}

Scene coated(float roughness, float coat_roughness) {
  Material m = glossy(roughness);
  m.clearcoat = 1;
  m.clearcoat_roughness = coat_roughness;
  Scene scene = with_ball(m);
  set(scene, ball, TextureSlot::clearcoat, noise(4, 4, 9, 30000));
  set(scene, ball, TextureSlot::clearcoat_normal, bumps(8, 10));
  scene.materials[lamp].clearcoat = 0.7F;
  return scene;
}

Scene lit_without_surface() {
  Scene scene = room();
  scene.materials[lamp].emission = glm::vec3(0);
  PunctualLight point, spot, sun;
  point.position = {-0.6F, 0.5F, 0.4F};
  point.intensity = {0.5F, 0.4F, 0.3F};
  point.range = 1.6F;
  spot.kind = PunctualLight::Kind::spot;
  spot.position = {0.5F, 0.8F, 0.5F};
  spot.direction = glm::normalize(glm::vec3(-0.3F, -1, -0.5F));
  spot.intensity = {2, 3, 4};
  spot.inner_cone_angle = 0.2F;
  spot.outer_cone_angle = 0.5F;
  sun.kind = PunctualLight::Kind::directional;  // the walls keep it out
  scene.lights = {point, spot, sun};
  return scene;
}

// A lamp, a ball and a floor below it within a block of glass that absorbs, seen from without.
Scene in_glass() {
  Scene scene = furnace_box(0, 0, 0.9F);
  // The box turned inside out.
  for (Triangle& t : scene.triangles) {
    std::swap(t.position[1], t.position[2]);
    for (glm::vec3& n : t.normal) n = -n;
  }
  Material block = volume(0);
  block.ior = 1.2F;
  const Material matt = lambert({0.8F, 0.6F, 0.7F});
  scene.materials = {block, lambert(glm::vec3(0), {6, 5, 4}), matt};
  add_quad(scene, {-0.3F, 0.7F, -0.3F}, {0.6F, 0, 0}, {0, 0, 0.6F}, lamp);
  add_ball(scene, {0, -0.2F, 0}, 0.5F, ball);
  add_quad(scene, {-0.7F, -0.8F, -0.7F}, {0, 0, 1.4F}, {1.4F, 0, 0}, ball);
  scene.camera = look_at({-1, 1.5F, 2.5F}, {0, 0, 0}, 0.7F);
  return scene;
}

// The lamp in a block of smooth glass that absorbs: all light leaves a denser medium before it meets
// anything.
Scene lamp_in_glass() {
  Scene scene = room();
  const auto block = static_cast<std::uint32_t>(scene.materials.size());
  scene.materials.push_back(volume(0));
  const glm::vec3 lo(-0.7F, 0.6F, -0.7F), x(1.4F, 0, 0), y(0, 0.38F, 0), z(0, 0, 1.4F);
  // Their front faces look outwards.
  for (const auto& [corner, u, v] : std::vector<std::array<glm::vec3, 3>>{
           {{lo, x, z}}, {{lo + y, z, x}}, {{lo, z, y}}, {{lo + x, y, z}}, {{lo, y, x}}, {{lo + z, x, y}}}) {
    add_quad(scene, corner, u, v, block);
  }
  return scene;
}

Scene unlit() {
  Material m;
  m.base_color = {0.8F, 0.5F, 0.2F};
  m.is_unlit = true;
  Scene scene = with_ball(m);
  set(scene, ball, TextureSlot::base_color, noise(6, 6, 11));
  return scene;
}

Scene thin() {
  Material m = glass(0.4F);
  m.transmission = 0.8F;
  Scene scene = with_ball(m);
  set(scene, ball, TextureSlot::transmission, noise(4, 4, 12));
  return scene;
}

Material metal() {
  Material m;
  m.base_color = {0.9F, 0.8F, 0.5F};
  m.roughness = 0;
  return m;
}

}  // namespace

Scene feature_room(const std::string& name) {
  const std::map<std::string, std::function<Scene()>> rooms{
      {"textures", textured},
      {"normals", bumpy},
      {"alpha", veiled},
      {"plastic", [] { return with_ball(glossy(0)); }},
      {"mirror", [] { return with_ball(metal()); }},
      {"thin", thin},
      {"glass", [] { return with_ball(volume(0)); }},
      {"rough_glass", [] { return with_ball(volume(0.5F)); }},
      {"coat", [] { return coated(0.6F, 0); }},
      {"rough_coat", [] { return coated(1, 0.5F); }},
      {"in_glass", in_glass},
      {"lamp_in_glass", lamp_in_glass},
      {"unlit", unlit},
      {"sky", [] { return roofless(false); }},
      {"sky_and_lamp", [] { return roofless(true); }},
      {"punctual", lit_without_surface}};
  return rooms.at(name)();
}

}  // namespace qtrace::independent
