// The Q-table's arithmetic: gathering in fixed point, the update, and that thread order leaves no trace.
#include "engine/gltf/load_gltf.h"
#include "tests/support/learning_stage.h"
#include "tests/support/render.h"
#include "tests/support/goswami.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

namespace qtrace::test {
namespace {

class Learning : public LearningStage {};

// A light of radiance 1e8 and a room at 1e-3 in one table, far past 32 bits.
TEST_F(Learning, HoldsElevenDecades) {
  teach("index & 1u", "(index & 1u) == 0u ? 1e8 : 1e-3", 1 << 16);
  EXPECT_NEAR(table_->values()[0] / 1e8, 1, 1e-6);
  EXPECT_NEAR(table_->values()[1] / 1e-3, 1, 1e-3);
}

// Sum and number of the targets share words: what runs over in the one must not reach the other. So many
// counts run over in all words.
TEST_F(Learning, CountsDoNotReachTheSums) {
  constexpr std::uint32_t kTargets = (1 << 20) + 77;
  teach("0u", "1.0 / 1048576.0", kTargets);
  EXPECT_FLOAT_EQ(table_->values()[0] * 1048576, 1);
  EXPECT_EQ(table_->visits()[0], kTargets);
}

// Past the limit a sum stays at the limit: it neither wraps, as the words of so many would, nor depends on
// the order of threads.
TEST_F(Learning, SaturatesInsteadOfWrapping) {
  constexpr std::uint32_t kTargets = 1 << 20;
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
  const auto drawn =
      probe<glm::vec4>("vec4", {"shared/variants.glsl", "learning/qtable.glsl"}, "",
                       "result = vec4(action_probability(first_bin(index / 4u), 4u, index % 4u));",
                       static_cast<std::uint32_t>(values.size()), defines_);
  const double floor = settings_.rl.bin_floor;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool is_taught = i / bins == 2;
    const double expected = is_taught ? (1 - floor) * taught[i % bins] / 8 + floor / bins : 1.0 / bins;
    EXPECT_NEAR(drawn[i].x, expected, 1e-6) << i;
  }
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
      "uvec4",
      {"shared/variants.glsl", "learning/cells.glsl", "learning/qtable.glsl", "geometry/camera.glsl",
       "geometry/traverse.glsl"},
      "",
      kViewedSurface +
          "Cell cell = find_cell(s);\n"
          "uint bin = bin_of(to_cell(cell, s.normal, normalize(vec3(0.0, 1.0, 0.0) - s.position)));\n"
          "result = uvec4(uint(cell.index), bin, 0u, 0u);",
      1, shader_defines(settings, buffers_->features()));
  const auto cell = values.begin() + found[0].x * 36;
  EXPECT_EQ(std::max_element(cell, cell + 36) - cell, found[0].y);
}

// A search that is cut says so: among 100,000 sites, one after the other and four a turn, or through their
// tree.
TEST_F(Learning, CutSearchForCellsIsNoticed) {
  if (device().device().loop_limit == 0)
    GTEST_SKIP() << "this driver cuts no loops";
  settings_.rl.sites_per_object = 100000;
  const QTable table(scene_, settings_.rl, 4, defines_, device().programs());
  table.bind();
  const std::string body =
      kViewedSurface +
      "int sum = 0;\nfor (int i = 0; i < SEARCHES; ++i) { s.position.x += 1e-5; sum += find_cell(s).index; "
      "}\n"
      "result = uvec4(uint(sum), loop_was_cut ? 1u : 0u, 0u, 0u);";
  const auto is_cut = [&](SiteSearch search, const char* searches) {
    settings_.rl.site_search = search;
    gpu::Defines defines = shader_defines(settings_, buffers_->features());
    defines["SEARCHES"] = searches;
    const std::vector<std::string> files{"shared/variants.glsl", "learning/cells.glsl",
                                         "learning/qtable.glsl", "geometry/camera.glsl",
                                         "geometry/traverse.glsl"};
    return probe<glm::uvec4>("uvec4", files, "", body, 8, defines)[0].y == 1;
  };
  EXPECT_FALSE(is_cut(SiteSearch::linear, "1"));
  EXPECT_TRUE(is_cut(SiteSearch::linear, "4"));
  EXPECT_FALSE(is_cut(SiteSearch::tree, "100"));
  EXPECT_TRUE(is_cut(SiteSearch::tree, "10000"));
}

struct Bits {
  RadianceImage image;
  std::vector<float> values;
  std::vector<std::uint32_t> visits;
  std::uint64_t saturated = 0;
};

class GroupOrder : public testing::TestWithParam<UpdateRule> {};

Bits rendered(const Scene& scene, UpdateRule rule, const gpu::Defines& order) {
  RenderSettings settings;
  settings.rl = goswami_table();
  settings.width = settings.height = 64;  // 64 work groups
  settings.rl.sites_per_object = 20;
  settings.rl.update = rule;
  settings.nee = Nee::one_ray;
  settings.lights = LightChoice::learned;
  Tracer tracer(device(), scene, settings, order);
  Bits bits{render(tracer, 8).image, tracer.table()->values(), tracer.table()->visits()};
  bits.saturated = tracer.last_frame_counters().saturated_updates;
  return bits;
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void expect_the_same_in_any_order(const Scene& scene, UpdateRule rule, bool saturates) {
  const Bits plain = rendered(scene, rule, {});
  EXPECT_EQ(plain.saturated > 0, saturates);
  for (const char* threads :
       {"1", "2", "29"}) {  // as they come, from both halves in turn, far from neighbours
    const Bits shuffled = rendered(scene, rule, {{"WORK_THREADS", threads}, {"WORK_PIECE_BITS", "0"}});
    EXPECT_TRUE(same_bytes(plain.image.mean, shuffled.image.mean)) << threads;
    EXPECT_TRUE(same_bytes(plain.image.variance, shuffled.image.variance)) << threads;
    EXPECT_TRUE(same_bytes(plain.values, shuffled.values)) << threads;
    EXPECT_TRUE(same_bytes(plain.visits, shuffled.visits)) << threads;
    EXPECT_EQ(plain.saturated, shuffled.saturated) << threads;
  }
}

TEST_P(GroupOrder, LeavesNoTrace) {
  expect_the_same_in_any_order(load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/cornell_box.glb"), GetParam(),
                               false);
}

// Of a light so bright that sums and single targets reach the end of their range.
TEST_P(GroupOrder, LeavesNoTraceInSaturatedSums) {
  Scene scene = load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/cornell_box.glb");
  for (Material& material : scene.materials) material.emission *= 1e13F;
  expect_the_same_in_any_order(scene, GetParam(), GetParam() != UpdateRule::paper_listing);
}

INSTANTIATE_TEST_SUITE_P(Rules, GroupOrder,
                         testing::Values(UpdateRule::expected_sarsa, UpdateRule::sarsa,
                                         UpdateRule::q_learning, UpdateRule::monte_carlo,
                                         UpdateRule::paper_listing),
                         [](const auto& rule) { return std::string(enum_name(rule.param)); });

}  // namespace
}  // namespace qtrace::test
