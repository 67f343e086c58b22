#include "engine/device_scene/scene_buffers.h"

#include "engine/core/check.h"
#include "engine/device_scene/light_table.h"
#include "engine/device_scene/material_table.h"
#include "engine/device_scene/sky_table.h"
#include "engine/device_scene/vec4s.h"

#include <bit>
#include <utility>

namespace qtrace::gpu {
namespace {

const char* const kTexels = "the texels of all textures";

float as_float(uint bits) { return std::bit_cast<float>(bits); }

// Stands for kNoTriangle: all of its corners are one point, which no ray hits.
constexpr TriangleShape kPoint{};

std::vector<TriangleShape> pack_shapes(const Scene& scene, const Bvh& bvh) {
  std::vector<TriangleShape> shapes;
  shapes.reserve(bvh.order.size());
  for (const uint i : bvh.order) {
    if (i == kNoTriangle) {
      shapes.push_back(kPoint);
      continue;
    }
    const auto& p = scene.triangles[i].position;
    shapes.push_back({vec4(p[0], 0), vec4(p[1], 0), vec4(p[2], 0)});
  }
  return shapes;
}

// TriangleShade, and behind each corner's normal what else the features ask for.
class ShadePacker {
 public:
  ShadePacker(const Scene& scene, const SceneFeatures& features, std::size_t triangles)
      : scene_(scene), features_(features) {
    const int vec4s = 1 + (features.textures != 0) + features.tangents + features.colors;  // of a corner
    all_.reserve(3 * triangles * static_cast<std::size_t>(vec4s));
  }

  void add(const Triangle& t, uint light) {
    const std::array<uint, 3> links{t.material, t.object, light};
    const TriangleAttributes& attributes =
        t.attributes == kNoAttributes ? kPlain : scene_.attributes[t.attributes];
    for (std::size_t i = 0; i < 3; ++i) {
      all_.emplace_back(t.normal[i], as_float(links[i]));
      if (features_.textures != 0) all_.emplace_back(t.uv[i], attributes.uv1[i]);
      if (features_.tangents) all_.push_back(attributes.tangent[i]);
      if (features_.colors) all_.push_back(attributes.color[i]);
    }
  }

  std::vector<vec4> all() && { return std::move(all_); }

 private:
  inline static const TriangleAttributes kPlain;
  const Scene& scene_;
  const SceneFeatures& features_;
  std::vector<vec4> all_;
};

std::vector<vec4> pack_shades(const Scene& scene, const Bvh& bvh, const LightTable& lights,
                              const SceneFeatures& features) {
  ShadePacker packer(scene, features, bvh.order.size());
  for (const uint i : bvh.order) {
    if (i == kNoTriangle) {
      packer.add(Triangle{}, NO_LIGHT);
      continue;
    }
    packer.add(scene.triangles[i], lights.triangle_of[i]);
  }
  return std::move(packer).all();
}

// Where the lights' triangles stand in the order of the leaves.
std::vector<LightTriangle> with_places(const LightTable& lights, const Bvh& bvh) {
  std::vector<LightTriangle> triangles = lights.triangles;
  for (std::size_t place = 0; place < bvh.order.size(); ++place) {
    const uint i = bvh.order[place];
    if (i == kNoTriangle || lights.triangle_of[i] == NO_LIGHT) continue;
    triangles[lights.triangle_of[i]].link.w = static_cast<uint>(place);
  }
  return triangles;
}

// The environment's texels behind the lights.
std::vector<vec4> pack_lights(const Scene& scene, const LightTable& lights) {
  std::vector<vec4> all;
  for (const Light& light : lights.lights) append_vec4s(all, light);
  if (!lights.has_sky) return all;
  const std::vector<SkyTexel> sky = build_sky_table(*scene.environment);
  all.reserve(all.size() + sky.size() * vec4s_of<SkyTexel>());
  for (const SkyTexel& texel : sky) append_vec4s(all, texel);
  return all;
}

}  // namespace

SceneBuffers::SceneBuffers(const Scene& scene, const Bvh& bvh, LightChoice lights)
    : SceneBuffers(scene, bvh, build_light_table(scene, lights), build_texture_table(scene)) {}

SceneBuffers::SceneBuffers(const Scene& scene, const Bvh& bvh, const LightTable& lights,
                           const TextureTable& textures)
    : features_(find_features(scene, lights)),
      nodes_(bvh, glm::vec3(scene.camera.world_from_camera[3])),
      shapes_("triangle shapes", pack_shapes(scene, bvh), only_fetched(Texels::float4)),
      shades_("triangle normals", pack_shades(scene, bvh, lights, features_), only_fetched(Texels::float4)),
      materials_("materials", pack_materials(scene, textures), only_fetched(Texels::float4)),
      light_triangles_("light triangles", with_places(lights, bvh), only_fetched(Texels::float4)),
      lights_("lights", pack_lights(scene, lights), only_fetched(Texels::float4)),
      texels_(kTexels, textures.texels, only_fetched(Texels::half4)) {
  for (const qtrace::Material& m : scene.materials) {
    if (!has_specular_lobe(m) || m.roughness >= LEAST_ROUGHNESS || m.roughness == 0) continue;
    warnings_.push_back(
        fmt::format("material '{}' has roughness {}, which is rendered as 0, a mirror: single precision "
                    "knows no lobe that narrow",
                    m.name, m.roughness));
  }
}

void check_texels(const Scene& scene) {
  check_buffer_size(kTexels, count_texels(scene) * sizeof(HalfTexel), only_fetched(Texels::half4));
}

void SceneBuffers::bind() const {
  nodes_.bind();
  shapes_.bind_fetched(UNIT_SHAPES);
  shades_.bind_fetched(UNIT_SHADES);
  materials_.bind_fetched(UNIT_MATERIALS);
  light_triangles_.bind_fetched(UNIT_LIGHT_TRIANGLES);
  lights_.bind_fetched(UNIT_LIGHTS);
  texels_.bind_fetched(UNIT_TEXELS);
}

std::size_t SceneBuffers::bytes() const {
  return nodes_.bytes() + shapes_.bytes() + shades_.bytes() + materials_.bytes() + light_triangles_.bytes() +
         lights_.bytes() + texels_.bytes();
}

}  // namespace qtrace::gpu
