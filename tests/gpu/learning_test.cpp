// The Q-table's arithmetic: gathering in fixed point, the update, and that thread order leaves no trace.
#include "engine/gpu/scene_buffers.h"
#include "engine/scene/analytic.h"
#include "engine/scene/gltf.h"
#include "engine/tracer/parameters.h"
#include "engine/tracer/qtable.h"
#include "engine/tracer/shader_variant.h"
#include "tests/support/probe.h"
#include "tests/support/render.h"

#include <gtest/gtest.h>

#include <cstring>

namespace qtrace::test {
namespace {

// Sets `s` to what the middle of the image shows, seen along `d`.
const std::string kViewedSurface =
    "vec3 d = camera_direction(vec2(parameters.image.xy) * 0.5);\n"
    "Surface s = surface_at(closest_hit(parameters.camera_origin.xyz, d), d);\n";

class Learning : public testing::Test {
 protected:
  Learning() {
    scene_ = lit_floor(0.8F, 10, 1, 1).scene;
    settings_.rl.sites_per_object = 4;
    settings_.rl.bins_theta = settings_.rl.bins_phi = 2;
    buffers_.emplace(scene_, build_median_bvh(scene_, 4));
    defines_ = shader_defines(settings_, buffers_->features());
    table_.emplace(scene_, settings_.rl, 4, defines_);
    const gpu::Parameters parameters = 
        make_parameters(scene_.camera, settings_, buffers_->features(), table_->cells().count());
    block_.write(0, &parameters, sizeof(parameters));
    block_.bind_uniform(gpu::BINDING_PARAMETERS);
    statistics_.bind_storage(gpu::BINDING_STATISTICS);
    buffers_->bind();
    table_->reset();
  }

  // `count` threads each give the target `expression` to entry `entry`; then the frame's update.
  void teach(const std::string& entry, const std::string& expression, std::uint32_t count) {
    table_->bind();
    probe<glm::uvec4>("uvec4", {"variants.glsl", "qtable.glsl"}, "",
                      "result = uvec4(gather_target(" + entry + ", " + expression + ") ? 1u : 0u);", count,
                      defines_);
    statistics_.bind_storage(gpu::BINDING_STATISTICS);
    table_->learn();
    device().finish();
  }

  const gpu::Context& context_ = device();  // before the first buffer
  // What the viewed surface adds to a target that arrives there.
  static float next_value_in_view(const gpu::Defines& defines) {
    return probe<glm::vec4>(
               "vec4", {"variants.glsl", "qtable.glsl", "camera.glsl"}, "",
               kViewedSurface + "result = vec4(next_value(s, bsdf_of(s.material), -d, find_cell(s), vec3(1.0), vec3(0.0)));", 1,
               defines)[0]
        .x;
  }

  Scene scene_;
  RenderSettings settings_;
  std::optional<gpu::SceneBuffers> buffers_;
  gpu::Defines defines_;
  std::optional<QTable> table_;
  gpu::Buffer block_{"parameters", sizeof(gpu::Parameters)};
  gpu::Buffer statistics_{"statistics", 4096};
};

// alpha = 1 / (1 + visits) makes the value the mean of all targets, frame by frame.
TEST_F(Learning, ValueIsTheMeanOfItsTargets) {
  teach("3u", "float(index)", 101);  // mean 50
  EXPECT_NEAR(table_->values()[3], 50, 1e-4);
  EXPECT_EQ(table_->visits()[3], 101U);
  teach("3u", "200.0", 50);
  EXPECT_NEAR(table_->values()[3], (101 * 50 + 50 * 200) / 151.0, 1e-3);
  EXPECT_EQ(table_->visits()[3], 151U);
  EXPECT_EQ(table_->values()[2], 0);
  EXPECT_EQ(table_->visits()[4], 0U);
}

// A light of radiance 1e8 and a room at 1e-3 in one table, far past 32 bits.
TEST_F(Learning, HoldsElevenDecades) {
  teach("index & 1u", "(index & 1u) == 0u ? 1e8 : 1e-3", 1 << 16);
  EXPECT_NEAR(table_->values()[0] / 1e8, 1, 1e-6);
  EXPECT_NEAR(table_->values()[1] / 1e-3, 1, 1e-3);
}

// Past the limit a sum stays at the limit: it neither wraps nor depends on the order of threads.
TEST_F(Learning, SaturatesInsteadOfWrapping) {
  constexpr std::uint32_t kTargets = 1 << 17;
  teach("0u", "1e30", kTargets);
  const double limit = 9223372036854775808.0 / 1048576.0;
  EXPECT_NEAR(table_->values()[0] / (limit / kTargets), 1, 1e-5);
}

// p(bin) = (1 - floor) Q / sum of Q + floor / bins; uniform where nothing was learned.
TEST_F(Learning, BinsAreDrawnInProportionToTheirValues) {
  const std::size_t bins = 4;
  std::vector<float> values(table_->values().size(), 0.0F);
  const std::vector<float> taught{1, 5, 0, 2};
  std::copy(taught.begin(), taught.end(), values.begin() + 2 * bins);
  table_->set_values(values);
  const auto drawn = probe<glm::vec4>("vec4", {"variants.glsl", "qtable.glsl"}, "",
                                      "result = vec4(column_probability(first_bin(index / 4u), 4u, index % 4u));",
                                      static_cast<std::uint32_t>(values.size()), defines_);
  const double floor = settings_.rl.bin_floor;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool is_taught = i / bins == 2;
    const double expected = is_taught ? (1 - floor) * taught[i % bins] / 8 + floor / bins : 1.0 / bins;
    EXPECT_NEAR(drawn[i].x, expected, 1e-6) << i;
  }
}

// With the same radiance L from everywhere, expected SARSA expects rho L back from a Lambert surface: by the
// prepared irradiance, and by the quadrature over bins that scenes with glossy materials use.
TEST_F(Learning, ExpectationOfAConstantTableIsReflectanceTimesRadiance) {
  for (const bool glossy : {false, true}) {
    SCOPED_TRACE(glossy ? "quadrature" : "prepared");
    Scene scene = scene_;
    if (glossy) scene.materials[1].metallic = 1;
    const gpu::SceneBuffers buffers(scene, build_median_bvh(scene, 4));
    buffers.bind();
    const gpu::Defines defines = shader_defines(settings_, buffers.features());
    table_->set_values(std::vector<float>(table_->values().size(), 3.0F));
    const float next = next_value_in_view(defines);
    EXPECT_NEAR(next, 0.8 * 3, 1e-4);
  }
}

// q_learning: the best bin's value, discounted by the reflectance.
TEST_F(Learning, QLearningTakesTheBestBin) {
  settings_.rl.update = UpdateRule::q_learning;
  defines_ = shader_defines(settings_, buffers_->features());
  table_.emplace(scene_, settings_.rl, 4, defines_);
  std::vector<float> values(table_->values().size(), 1.0F);
  for (std::size_t i = 2; i < values.size(); i += 4) values[i] = 7;
  table_->set_values(values);
  const float next = next_value_in_view(defines_);
  EXPECT_NEAR(next, 0.8 * 7, 1e-4);
}

// The bin that learns is the bin that the light stands in: of a floor's cells, seen obliquely.
TEST_F(Learning, BrightestBinFacesTheLight) {
  LitFloor lit = lit_floor(0.8F, 100, 0.6F, 1);
  lit.scene.camera = look_at({2.4F, 1, 1.6F}, {1.4F, 0, 0.8F}, 0.1F);
  RenderSettings settings = settings_;
  settings.width = settings.height = 32;
  settings.max_bounces = 1;
  settings.rl.bins_theta = settings.rl.bins_phi = 6;
  Tracer tracer(device(), lit.scene, settings);
  render(tracer, 64);
  const std::vector<float> values = tracer.table()->values();
  const auto found = probe<glm::uvec4>(
      "uvec4", {"variants.glsl", "qtable.glsl", "camera.glsl"}, "",
      kViewedSurface +
          "Cell cell = find_cell(s);\n"
          "uint bin = bin_of(to_cell(cell, s.normal, normalize(vec3(0.0, 1.0, 0.0) - s.position)));\n"
          "result = uvec4(uint(cell.index), bin, 0u, 0u);",
      1, shader_defines(settings, buffers_->features()));
  const auto cell = values.begin() + found[0].x * 36;
  EXPECT_EQ(std::max_element(cell, cell + 36) - cell, found[0].y);
}

// A search that is cut says so: each of these looks through 100,000 sites, four a turn.
TEST_F(Learning, CutSearchForCellsIsNoticed) {
  if (device().device().renderer.find("llvmpipe") == std::string::npos)
    GTEST_SKIP() << "no loop budget is known";
  RlSettings many = settings_.rl;
  many.sites_per_object = 100000;
  const QTable table(scene_, many, 4, defines_);
  table.bind();
  const std::string search =
      kViewedSurface +
      "int sum = 0;\nfor (int i = 0; i < SEARCHES; ++i) { s.position.x += 1e-3; sum += find_cell(s).index; "
      "}\n"
      "result = uvec4(uint(sum), loop_was_cut ? 1u : 0u, 0u, 0u);";
  for (const auto& [searches, is_cut] : {std::pair{"1", 0U}, std::pair{"4", 1U}}) {
    gpu::Defines defines = defines_;
    defines["SEARCHES"] = searches;
    const auto found =
        probe<glm::uvec4>("uvec4", {"variants.glsl", "qtable.glsl", "camera.glsl"}, "", search, 8, defines);
    EXPECT_EQ(found[0].y, is_cut) << searches << " searches";
  }
}

TEST_F(Learning, SeveralFramesOfOneSeedGiveTheSameBits) {
  const Scene scene = load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/cornell_box.glb");
  RenderSettings settings;
  settings.width = settings.height = 64;
  settings.rl.sites_per_object = 20;
  std::vector<RadianceImage> images;
  std::vector<std::vector<float>> tables;
  for (int i = 0; i < 2; ++i) {
    Tracer tracer(device(), scene, settings);
    images.push_back(render(tracer, 8).image);
    tables.push_back(tracer.table()->values());
  }
  EXPECT_EQ(
      std::memcmp(images[0].mean.data(), images[1].mean.data(), images[0].pixels() * sizeof(glm::dvec3)), 0);
  EXPECT_EQ(std::memcmp(images[0].variance.data(), images[1].variance.data(),
                        images[0].pixels() * sizeof(glm::dvec3)),
            0);
  EXPECT_EQ(tables[0], tables[1]);
}

// In the furnace the incident radiance is Le / (1 - albedo) from everywhere: expected SARSA must find it.
TEST_F(Learning, ExpectedSarsaFindsTheFurnacesRadiance) {
  RenderSettings settings;
  settings.width = settings.height = 32;
  settings.max_bounces = 8;
  settings.rl.sites_per_object = 4;
  settings.rl.bins_theta = settings.rl.bins_phi = 4;
  Tracer tracer(device(), furnace_box(0.5F, 1.0F), settings);
  render(tracer, 400);
  const std::vector<float> values = tracer.table()->values();
  const std::vector<std::uint32_t> visits = tracer.table()->visits();
  double sum = 0;
  double entries = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (visits[i] == 0) continue;  // back faces
    sum += values[i];
    ++entries;
  }
  EXPECT_GT(entries, 0.49 * static_cast<double>(values.size()));
  // The running mean keeps its first, too dark targets: it approaches 2 from below.
  EXPECT_NEAR(sum / entries, 2, 0.1);
}

}  // namespace
}  // namespace qtrace::test
