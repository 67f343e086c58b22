#include "tests/bench/feature_bench.h"

#include "experiments/files/atomic_file.h"
#include "experiments/files/csv.h"
#include "experiments/files/text_table.h"
#include "tests/bench/rounds.h"
#include "tests/bench/scenes.h"

#include <glm/geometric.hpp>

#include <cstdio>
#include <functional>
#include <memory>
#include <random>

namespace qtrace::bench {
namespace {

constexpr std::uint32_t kSide = 1024;  // of images
constexpr int kBounces = 5;

struct Feature {
  std::string name;
  std::function<void(Scene&)> add;
};

struct Row {
  std::string feature;
  int size;
  Spread wall_ms;
  Spread over_plain;      // by the clock
  Spread cpu_over_plain;  // by processor time
  double rays_over_plain;
};

const std::vector<experiments::Column<Row>>& columns() {
  static const std::vector<experiments::Column<Row>> all{
      {"feature", [](const Row& r) { return r.feature; }},
      {"size", [](const Row& r) { return std::int64_t{r.size}; }},
      {"wall_ms", [](const Row& r) { return r.wall_ms.median; }},
      {"wall_ms_low", [](const Row& r) { return r.wall_ms.low; }},
      {"wall_ms_high", [](const Row& r) { return r.wall_ms.high; }},
      {"over_plain", [](const Row& r) { return r.over_plain.median; }},
      {"over_plain_low", [](const Row& r) { return r.over_plain.low; }},
      {"over_plain_high", [](const Row& r) { return r.over_plain.high; }},
      {"cpu_over_plain", [](const Row& r) { return r.cpu_over_plain.median; }},
      {"rays_over_plain", [](const Row& r) { return r.rays_over_plain; }},
  };
  return all;
}

TextureImage noise(std::uint16_t least) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> codes(least, 65535);
  TextureImage image{"noise", kSide, kSide, {}};
  const auto code = [&] { return static_cast<std::uint16_t>(codes(random)); };
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) image.texels.push_back({code(), code(), code(), 65535});
  return image;
}

template <class Edit>
void for_each_reflecting(Scene& scene, Edit edit) {
  for (Material& material : scene.materials) {
    if (material.emission == glm::vec3(0)) edit(material);
  }
}

std::function<void(Scene&)> every_material(const std::function<void(Material&)>& edit) {
  return [edit](Scene& scene) { for_each_reflecting(scene, edit); };
}

std::function<void(Scene&)> textures(const std::vector<TextureSlot>& slots) {
  return [slots](Scene& scene) {
    scene.images.push_back(noise(30000));
    for_each_reflecting(scene, [&](Material& material) {
      for (const TextureSlot slot : slots) material.texture(slot) = Texture{};
    });
    for (Triangle& t : scene.triangles) {
      TriangleAttributes attributes;
      const glm::vec3 along = glm::normalize(t.position[1] - t.position[0]);
      attributes.tangent.fill(glm::vec4(along, 1));
      t.attributes = static_cast<std::uint32_t>(scene.attributes.size());
      scene.attributes.push_back(attributes);
    }
  };
}

void make_glossy(Material& material, float roughness) {
  material.specular = 1;
  material.roughness = roughness;
}

void add_coat(Material& material) {
  make_glossy(material, 0.3F);
  material.clearcoat = 1;
}

void add_sky(Scene& scene) {
  EnvironmentMap sky{512, 256, std::vector<glm::vec3>(512 * 256, glm::vec3(0.1F)), 0};
  sky.radiance[100 * 512 + 7] = glm::vec3(1000);
  scene.environment = sky;
}

void add_point(Scene& scene) {
  PunctualLight light;
  light.position = glm::vec3(scene.camera.world_from_camera[3]);
  scene.lights.push_back(light);
}

std::vector<Feature> features() {
  using enum TextureSlot;
  const auto glass = [](Material& m) {
    make_glossy(m, 0);
    m.transmission = 0.5F;
  };
  return {{"plain: Lambert and a lamp", [](Scene&) {}},
          {"textures of base colour", textures({base_color})},
          {"textures of normals", textures({normal})},
          {"glossy lobes, roughness 0.3", every_material([](Material& m) { make_glossy(m, 0.3F); })},
          {"glossy lobes and five textures", [](Scene& scene) {
             for_each_reflecting(scene, [](Material& m) { make_glossy(m, 1); });
             textures({base_color, metallic_roughness, normal, specular, specular_color})(scene);
           }},
          {"masks, all opaque", every_material([](Material& m) { m.alpha_mode = AlphaMode::mask; })},
          {"smooth plastic", every_material([](Material& m) { make_glossy(m, 0); })},
          {"half transmitting, smooth", every_material(glass)},
          {"clearcoat over roughness 0.3", every_material(add_coat)},
          {"an image of the sky beside the lamp", add_sky},
          {"a point beside the lamp", add_point}};
}

RenderSettings settings_of(int size) {
  RenderSettings settings;
  settings.random = RandomNumbers::independent;
  settings.width = settings.height = size;
  settings.max_bounces = settings.russian_roulette_start = kBounces;
  settings.sampler = Sampler::bsdf;
  settings.nee = Nee::one_ray;
  return settings;
}

void print(const std::vector<Row>& rows) {
  std::vector<std::vector<std::string>> cells;
  for (const Row& r : rows) {
    cells.push_back({r.feature, text_of(r.wall_ms), text_of(r.over_plain), fmt::format("{:.3g}", r.cpu_over_plain.median),
                     fmt::format("{:.3g}", r.rays_over_plain)});
  }
  fmt::print("\n{}\n", experiments::markdown_table({"feature", "ms/frame", "over plain", "by CPU time", "rays over plain"},
                                                   cells, 1));
  std::fflush(stdout);
}

}  // namespace

void bench_features(const gpu::Context& context, const FrameBenchOptions& options) {
  std::vector<std::unique_ptr<Tracer>> tracers;
  std::vector<Contender> contenders;
  for (const Feature& feature : features()) {
    Scene scene = bench_scene(QTRACE_SOURCE_DIR "/configs/scenes/simple.glb");
    feature.add(scene);
    tracers.push_back(std::make_unique<Tracer>(context, scene, settings_of(options.size)));
    contenders.push_back({feature.name, [&context, tracer = tracers.back().get()] { return timed_frame(context, *tracer); }});
  }
  run_rounds(contenders, options.rounds);
  const auto rays = [&](std::size_t i) { return static_cast<double>(tracers[i]->last_frame_counters().rays); };
  std::vector<Row> rows;
  std::vector<RoundRow> rounds;
  for (std::size_t i = 0; i < contenders.size(); ++i) {
    const Contender& c = contenders[i];
    rows.push_back({c.name, options.size, kMilliseconds * spread_of(c.wall_s), ratio_of(c.wall_s, contenders[0].wall_s),
                    ratio_of(c.cpu_s, contenders[0].cpu_s), rays(i) / rays(0)});
    append_rounds(rounds, {c.name}, c);
  }
  print(rows);
  experiments::write_file(options.out / "features.csv", experiments::csv_text(columns(), rows));
  experiments::write_file(options.out / "feature_rounds.csv", rounds_csv({"feature"}, rounds));
}

}  // namespace qtrace::bench
