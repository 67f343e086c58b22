// Lights: what belongs together, how each rule chooses, and what a choice teaches.
#include "engine/accel/build_bvh.h"
#include "engine/device_scene/alias_table.h"
#include "engine/device_scene/light_table.h"
#include "tests/support/learning_stage.h"
#include "tests/support/render.h"
#include "tests/support/goswami.h"
#include "tests/support/statistics.h"

#include <algorithm>
#include <cmath>

namespace qtrace::test {
namespace {

// A floor under four lights: two quads of one object, which do not touch; a double-sided one; and a
// tessellated one.
Scene four_lights() {
  Scene scene = lit_floor(0.8F, 10, 1, 1).scene;
  const auto add_material = [&](float radiance, bool both) {
    scene.materials.push_back(lambert(glm::vec3(0), glm::vec3(radiance)));
    scene.materials.back().double_sided = both;
    return static_cast<std::uint32_t>(scene.materials.size() - 1);
  };
  add_quad(scene, {3, 2, 0}, {1, 0, 0}, {0, 0, 1}, add_material(20, true));
  const std::uint32_t pair = add_material(5, false);
  add_quad(scene, {-3, 2, 0}, {1, 0, 0}, {0, 0, 2}, pair);
  add_quad(scene, {-6, 2, 0}, {1, 0, 0}, {0, 0, 1}, pair);
  // The last two quads become one object.
  Object last = scene.objects.back();
  scene.objects.pop_back();
  for (std::uint32_t i = 0; i < last.triangle_count; ++i) {
    scene.triangles[last.first_triangle + i].object = static_cast<std::uint32_t>(scene.objects.size() - 1);
  }
  scene.objects.back().triangle_count += last.triangle_count;
  return scene;
}

TEST(LightTable, ALightIsAConnectedSurfaceOfOneObject) {
  const gpu::LightTable table = gpu::build_light_table(four_lights(), LightChoice::power);
  ASSERT_EQ(table.lights.size(), 4U);
  EXPECT_EQ(table.triangles.size(), 8U);
  EXPECT_EQ(table.brightest, 20);
  const std::vector<double> powers{10 * 1, 20 * 1 * 2, 5 * 2, 5 * 1};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(table.lights[i].link.w, 2U);
    EXPECT_NEAR(table.lights[i].choice.x, powers[i] / 65, 1e-6);
    EXPECT_NEAR(table.lights[i].choice.y, powers[i] / 65, 1e-6);
  }
  const gpu::LightTable alike = gpu::build_light_table(four_lights(), LightChoice::uniform);
  for (const gpu::Light& light : alike.lights) EXPECT_EQ(light.choice.x, 0.25F);
  for (std::uint32_t i = 0; i < table.triangles.size(); ++i) {
    EXPECT_EQ(table.triangles[i].link.y, i / 2);
    EXPECT_NEAR(table.triangles[i].edge2.w, 0.5 / (i / 2 == 2 ? 1.0 : 0.5), 1e-6);
  }
}

TEST(AliasTable, GivesEverySlotItsWeight) {
  const std::vector<double> weights{1, 0.001, 5, 2, 2, 1e-9, 30};
  const auto slots = gpu::build_aliases(weights);
  std::vector<double> chance(weights.size(), 0.0);
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const double own = slots[i].threshold / 4294967296.0;
    chance[i] += own / static_cast<double>(slots.size());
    chance[slots[i].alias] += (1 - own) / static_cast<double>(slots.size());
  }
  for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_NEAR(chance[i], weights[i] / 40.001, 1e-6);
}

class LightChoices : public LearningStage {
 protected:
  void choose(LightChoice choice, Sampler sampler) {
    scene_ = four_lights();
    settings_.nee = Nee::one_ray;
    settings_.lights = choice;
    settings_.sampler = sampler;
    settings_.light_prior = 0;
    if (choice == LightChoice::learned || sampler == Sampler::rl) {
      build();
    }
  }

  // Draws against the stated probabilities, of the cell of the viewed surface.
  void expect_stated(const std::vector<double>& stated) {
    constexpr std::uint32_t kDraws = 1 << 18;
    const auto drawn = probe<glm::vec4>(
        "vec4", {"shared/variants.glsl", "learning/cells.glsl", "light/nee.glsl", "geometry/camera.glsl"}, "",
        kViewedSurface +
            "int cell = find_cell(s).index;\n"
            "uvec4 bits = random_bits(RandomKey(index, 1u, 9u), 2u);\n"
            "LightSample light = sample_light(s, cell, bits, random_bits(RandomKey(index, 1u, 9u), 4u).x);\n"
            "result = vec4(float(light.light), light.probability, light_probability(cell, light.light), "
            "0.0);",
        kDraws, defines_);
    std::vector<double> counts(stated.size());
    std::vector<double> expected;
    for (const double p : stated) expected.push_back(p * kDraws);
    for (const glm::vec4& v : drawn) {
      const auto light = static_cast<std::size_t>(v.x);
      ++counts[light];
      EXPECT_NEAR(v.y, stated[light], 1e-5);
      EXPECT_EQ(v.y, v.z);
    }
    EXPECT_GT(chi_squared_p(counts, expected), kFalseAlarm / 4);
  }
};

TEST_F(LightChoices, ByPower) {
  choose(LightChoice::power, Sampler::rl);
  expect_stated({10 / 65.0, 40 / 65.0, 10 / 65.0, 5 / 65.0});
}

TEST_F(LightChoices, Uniform) {
  settings_.lights = LightChoice::uniform;
  choose(LightChoice::uniform, Sampler::rl);
  buffers_.emplace(scene_, build_bvh(scene_, BvhKind::sah), LightChoice::uniform);
  buffers_->bind();
  expect_stated({0.25, 0.25, 0.25, 0.25});
}

// p = (1 - floor) sqrt(E[X^2]) / sum + floor * power, with a row of bins before the lights and without.
TEST_F(LightChoices, Learned) {
  for (const Sampler sampler : {Sampler::rl, Sampler::bsdf}) {
    SCOPED_TRACE(enum_name(sampler));
    choose(LightChoice::learned, sampler);
    expect_stated({10 / 65.0, 40 / 65.0, 10 / 65.0, 5 / 65.0});  // nothing learned: by power
    const std::size_t actions = table_->actions();
    EXPECT_EQ(actions, sampler == Sampler::rl ? 8U : 4U);
    std::vector<float> values(table_->values().size(), 1.0F);
    const std::vector<float> squares{4, 0, 0.25F, 1e-8F};
    for (std::size_t i = 0; i < values.size(); i += actions) {
      std::copy(squares.begin(), squares.end(),
                values.begin() + static_cast<std::ptrdiff_t>(i + actions - 4));
    }
    table_->set_values(values);
    const double floor = settings_.light_floor;
    std::vector<double> stated;
    const std::vector<double> power{10 / 65.0, 40 / 65.0, 10 / 65.0, 5 / 65.0};
    for (std::size_t i = 0; i < 4; ++i) {
      stated.push_back((1 - floor) * std::sqrt(squares[i]) / 2.5001 + floor * power[i]);
    }
    expect_stated(stated);
  }
}

// Thousands of lights, the last one weak, and nothing learned: whole words of 2^-32 go round exactly once.
TEST_F(LightChoices, ThousandsOfLightsFillTheRangeOnce) {
  scene_ = lit_floor(0.8F, 10, 1, 1).scene;
  constexpr std::uint32_t kMore = 5078;
  scene_.materials.push_back(lambert(glm::vec3(0), glm::vec3(1e-3F)));
  for (std::uint32_t i = 0; i < kMore; ++i) {
    const float x = static_cast<float>(i % 72) * 0.2F - 7;
    const float z = static_cast<float>(i / 72) * 0.2F - 7;
    add_quad(scene_, {x, 3, z}, {0.1F, 0, 0}, {0, 0, 0.1F}, i + 1 < kMore ? 1 : 2);
  }
  // All in the object of the first light.
  scene_.objects.resize(2);
  scene_.objects[1].triangle_count += 2 * kMore;
  for (std::uint32_t i = 4; i < scene_.triangles.size(); ++i) scene_.triangles[i].object = 1;
  settings_.sampler = Sampler::bsdf;
  settings_.nee = Nee::one_ray;
  settings_.lights = LightChoice::learned;
  settings_.light_prior = 0;
  build();
  ASSERT_EQ(table_->actions(), kMore + 1);
  const gpu::LightTable lights = gpu::build_light_table(scene_, LightChoice::power);
  const auto found = probe<glm::vec4>("vec4", {"shared/variants.glsl", "light/nee.glsl"}, "",
                                      "result = vec4(light_probability(0, index));", kMore + 1, defines_);
  double sum = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    sum += found[i].x;
    EXPECT_NEAR(found[i].x, lights.lights[i].choice.y, 3e-6) << i;
  }
  EXPECT_NEAR(sum, 1, 1e-6);
}

// Before anything is learned: small lights straight above by the inverse square of their distance, and what
// faces away hardly at all. The guess counts as so many visits.
TEST(LearnedLights, StartFromWhatAnUnhiddenLightWouldBring) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.8F)), lambert(glm::vec3(0), glm::vec3(10))};
  add_quad(scene, {-10, 0, 0}, {0, 0, 20}, {20, 0, 0}, 0);  // its one site stands at (-10 + 20 v, 0, 20 u)
  RlSettings one_site = goswami_table();
  one_site.sites_per_object = 1;
  const CellSites sites = place_sites(scene, one_site);
  const glm::vec3 corner = sites.sites[0].position - glm::vec3(0.05F, 0, 0.05F);
  const auto add_light = [&](float height, bool faces_down) {
    const glm::vec3 u(0.1F, 0, 0);
    const glm::vec3 v(0, 0, 0.1F);
    add_quad(scene, corner + glm::vec3(0, height, 0), faces_down ? u : v, faces_down ? v : u, 1);
  };
  add_light(2, true);
  add_light(4, true);
  add_light(2.001F, false);
  scene.camera = look_at({0, 1, 0}, {0, 0, 1}, 1);
  RenderSettings settings;
  settings.rl = goswami_table();
  settings.width = settings.height = 16;
  settings.sampler = Sampler::bsdf;
  settings.nee = Nee::one_ray;
  settings.lights = LightChoice::learned;
  settings.light_prior = 3;
  settings.rl.sites_per_object = 1;
  Tracer tracer(device(), scene, settings);
  const std::vector<CellState>& states = tracer.table()->cells().states();
  const std::vector<float> values = tracer.table()->values();
  const std::vector<std::uint32_t> visits = tracer.table()->visits();
  ASSERT_GT(states[0].normal.y, 0.99F);  // the floor's front
  const double near = 0.5 / 3.141592653589793 * 0.01 / (4 + 0.01);
  const double far = 0.5 / 3.141592653589793 * 0.01 / (16 + 0.01);
  EXPECT_NEAR(values[0] / (near * near), 1, 1e-3);
  EXPECT_NEAR(values[1] / (far * far), 1, 1e-3);
  EXPECT_NEAR(values[2] / (near * near), 0.01, 1e-3);
  EXPECT_EQ(visits[0], 3U);
}

// A light below the floor teaches the cells above that it brings nothing; the one above, the mean square of
// what it brings: at the floor's middle radiance x albedo x form factor, if the light is small.
TEST(LearnedLights, AreTheMeanSquareOfTheirContribution) {
  const LitFloor lit = lit_floor(0.8F, 10, 0.2F, 2);
  Scene scene = lit.scene;
  scene.materials.push_back(lambert(glm::vec3(0), glm::vec3(40)));
  add_quad(scene, {-1, -1, -1}, {2, 0, 0}, {0, 0, 2}, static_cast<std::uint32_t>(scene.materials.size() - 1));
  scene.camera = look_at({1, 1, 1}, {0, 0, 0}, 0.05F);
  RenderSettings settings;
  settings.rl = goswami_table();
  settings.width = settings.height = 32;
  settings.max_bounces = 1;
  settings.sampler = Sampler::bsdf;
  settings.nee = Nee::one_ray;
  settings.lights = LightChoice::learned;
  settings.rl.sites_per_object = 1;
  settings.light_prior = 0;
  Tracer tracer(device(), scene, settings);
  render(tracer, 8);
  const std::vector<float> values = tracer.table()->values();
  const std::vector<std::uint32_t> visits = tracer.table()->visits();
  ASSERT_EQ(tracer.table()->actions(), 2U);
  const double contribution = lit.radiance(0, 0) / 40;  // in units of the brightest light
  int taught = 0;
  for (std::size_t cell = 0; cell < values.size() / 2; ++cell) {
    if (visits[2 * cell] == 0) continue;
    ++taught;
    EXPECT_NEAR(values[2 * cell] / (contribution * contribution), 1, 0.03);
    EXPECT_GT(visits[2 * cell + 1], 0U);
    EXPECT_EQ(values[2 * cell + 1], 0);
  }
  EXPECT_EQ(taught, 1);
}

}  // namespace
}  // namespace qtrace::test
