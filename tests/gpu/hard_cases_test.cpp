// Hard cases that are no renders. Their figures are recorded as properties for the stability report:
// `hard` (what is hard), `expected` and `measured`.
#include "tests/support/goswami.h"
#include "tests/support/learning_stage.h"
#include "tests/support/render.h"
#include "tests/support/statistics.h"

#include <fmt/format.h>

#include <cmath>

namespace qtrace::test {
namespace {

constexpr std::uint32_t kMillion = 1000000;

void record(const std::string& hard, const std::string& expected, const std::string& measured) {
  testing::Test::RecordProperty("hard", hard);
  testing::Test::RecordProperty("expected", expected);
  testing::Test::RecordProperty("measured", measured);
}

// A million frames of one pixel in one invocation per dispatch of kFrames: sums as the film keeps them, and
// as plain floats would.
struct LongSum {
  double film = 0;
  double plain = 0;
};

// `sample`: an expression of the frame's number, from 0.
LongSum sum_of_million(const std::string& sample) {
  constexpr std::uint32_t kFrames = 50000;  // below what drivers allow a loop
  gpu::Buffer sums("pixel sums", sizeof(gpu::PixelSum));
  sums.bind_storage(gpu::BINDING_SUMS);
  gpu::Buffer plain("plain sum", 16);
  plain.bind_storage(gpu::BINDING_OUTLIERS);
  const std::string text =
      "#version 450 core\n#include \"shared/structs.glsl\"\n#include \"passes/pixel_sum.glsl\"\n"
      "layout(local_size_x = 1) in;\n"
      "layout(location = LOCATION_FRAME) uniform uint frame_number;\n"
      "layout(std430, binding = BINDING_SUMS) buffer SumBuffer { PixelSum sums[]; };\n"
      "layout(std430, binding = BINDING_OUTLIERS) buffer PlainBuffer { float plain; };\n"
      "void main() {\n  uint i = 0u;\n  do {\n    uint frame = frame_number * " +
      std::to_string(kFrames) + "u + i;\n    float x = " + sample +
      ";\n    sums[0] = with_sample(sums[0], vec3(x), 1.0);\n    plain += x;\n    ++i;\n  } while (i < " +
      std::to_string(kFrames) + "u);\n}\n";
  gpu::Program program(gpu::assemble("long_sum", text, gpu::for_driver({})));
  for (std::uint32_t part = 0; part < kMillion / kFrames; ++part) {
    program.set_frame(part);
    program.dispatch(1);
  }
  device().finish();
  return {sums.read_all<gpu::PixelSum>()[0].r, plain.read_all<float>()[0]};
}

std::string sums_text(const LongSum& sum) {
  return fmt::format("{:.10g}; plain float32: {:.10g}", sum.film / kMillion, sum.plain / kMillion);
}

class HardCases : public LearningStage {};

TEST_F(HardCases, AMillionFramesKeepTheMean) {
  const LongSum sum = sum_of_million("0.1");
  const double exact = kMillion * double{0.1F};
  EXPECT_NEAR(sum.film / exact, 1, 1e-12);
  EXPECT_GT(std::abs(sum.plain / exact - 1), 1e-3);
  record("1,000,000 frames, each sample 0.1", fmt::format("mean {:.10g}", exact / kMillion), sums_text(sum));
}

TEST_F(HardCases, AMillionFramesAfterAFireflyDoNotStall) {
  const LongSum sum = sum_of_million("frame == 0u ? 1e8 : 1.0");
  const double exact = 1e8 + (kMillion - 1);
  EXPECT_NEAR(sum.film / exact, 1, 1e-12);
  EXPECT_EQ(sum.plain, 1e8);  // not one of the other samples has arrived
  record("1,000,000 frames, the first 1e8, all others 1", fmt::format("mean {:.10g}", exact / kMillion),
         sums_text(sum));
}

TEST_F(HardCases, AMillionUpdatesOfOneEntryAreTheirMean) {
  constexpr std::uint32_t kTargets = 10000;
  for (std::uint32_t frame = 0; frame < kMillion / kTargets; ++frame) {
    teach("3u", "float(index % 2u) * 3.0 + " + std::to_string(frame % 2) + ".0", kTargets);
  }
  const float value = table_->values()[3];
  EXPECT_NEAR(value, 2, 1e-4);
  EXPECT_EQ(table_->visits()[3], kMillion);
  record("1,000,000 updates of one table entry in 100 frames", "value 2, 1000000 visits",
         fmt::format("value {:.7g}, {} visits", value, table_->visits()[3]));
}

// Counters at their end neither wrap, which would let the next target replace all that was learned, nor stop
// the entry from being finite.
TEST_F(HardCases, VisitCountersAtTheirLimitDoNotWrap) {
  const float before = [&] {
    teach("3u", "5.0", 64);
    table_->bind();
    probe<glm::uvec4>("uvec4", {"shared/structs.glsl"},
                      "layout(std430, binding = BINDING_Q_VISITS) buffer Visits { uint visits[]; };\n",
                      "visits[3] = 0xffffffffu; result = uvec4(0u);", 1);
    return table_->values()[3];
  }();
  for (int frame = 0; frame < 8; ++frame) teach("3u", "1000.0", 1 << 16);
  const std::uint32_t visits = table_->visits()[3];
  const float value = table_->values()[3];
  EXPECT_EQ(before, 5);
  EXPECT_GE(visits, 0x7fffffffU);
  // 2^19 targets of 1000 among 2^31 visits or more.
  EXPECT_NEAR(value, 5, 0.3);
  record("a visit counter at 4294967295, then 524,288 targets of 1000 on a value of 5",
         "the value moves by less than 0.3, the counter stays above 2147483647",
         fmt::format("value {:.6g}, counter {}", value, visits));
}

// Entries at 0 and at the largest fixed-point value, in every mixture: the picture of a furnace does not
// change.
TEST_F(HardCases, TableEntriesAtBothEndsOfTheirRangeKeepTheImage) {
  constexpr float kLargest = 8796093022208.0F;  // 2^63 units of 2^-20
  constexpr float kAlbedo = 0.5F;
  const Scene scene = furnace_box(kAlbedo, 1);
  RenderSettings settings;
  settings.random = RandomNumbers::independent;
  settings.rl = goswami_table();
  settings.width = settings.height = 32;
  settings.max_bounces = 3;
  settings.rl.sites_per_object = 4;
  settings.rl.bins_theta = settings.rl.bins_phi = 4;
  settings.rl.bin_floor = 0.3;
  const double truth = furnace_radiance(kAlbedo, 1, settings.max_bounces);
  std::string measured;
  std::uint64_t saturated = 0;
  for (const UpdateRule rule : {UpdateRule::expected_sarsa, UpdateRule::sarsa, UpdateRule::q_learning}) {
    SCOPED_TRACE(enum_name(rule));
    settings.rl.update = rule;
    Tracer tracer(device(), scene, settings);
    std::vector<float> values(tracer.table()->values().size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = i % 3 == 0 ? kLargest : 0;
    tracer.table()->set_values(values);
    EXPECT_EQ(render(tracer, 1).non_finite, 0U);
    saturated += tracer.last_frame_counters().saturated_updates;
    const Rendering r = render(tracer, 63);
    EXPECT_EQ(r.non_finite, 0U);
    for (const float value : tracer.table()->values()) {
      ASSERT_TRUE(std::isfinite(value));
      ASSERT_GE(value, 0);
      ASSERT_LE(value, kLargest);
    }
    const Estimate mean = block_estimate(r.image, 0, 0, settings.width);
    EXPECT_LT(z_score(mean, {truth, 0}), z_threshold(3));
    measured += fmt::format("{}{} {:.4f} +- {:.4f}", measured.empty() ? "" : ", ", enum_name(rule), mean.mean,
                            std::sqrt(mean.variance));
  }
  EXPECT_GT(saturated, 0U);
  record("table entries at 0 and at 2^63 units, in a furnace", fmt::format("radiance {}, all finite", truth),
         fmt::format("{}; {} targets of the first frames saturated", measured, saturated));
}

// A full sum counts every target that it has lost, and a single one beyond the limit is counted as well. That
// of entry 1 does not end at the limit: its last target takes it beyond.
TEST_F(HardCases, TargetsBeyondTheFixedPointAreCounted) {
  constexpr std::uint32_t kTargets = 1 << 17;
  table_->bind();
  const auto clamped =
      probe<glm::uvec4>("uvec4", {"shared/variants.glsl", "learning/qtable.glsl"}, "",
                        "result = uvec4(gather_target(0u, 1e30) ? 1u : 0u);", kTargets, defines_);
  probe<glm::uvec4>("uvec4", {"shared/variants.glsl", "learning/qtable.glsl"}, "",
                    "gather_target(1u, 0.875 * TARGET_LIMIT * TARGET_UNIT); result = uvec4(0u);", kTargets,
                    defines_);
  counters_.bind_storage(gpu::BINDING_COUNTERS);
  counters_.clear();
  table_->learn();
  device().finish();
  std::uint64_t noticed = 0;
  for (const glm::uvec4& c : clamped) noticed += c.x;
  gpu::Counters block;
  counters_.read(0, &block, sizeof(block));
  const double limit = 9223372036854775808.0 / 1048576.0;
  EXPECT_EQ(noticed, kTargets);
  EXPECT_EQ(block.words[2 * gpu::COUNTER_SATURATED], 2 * kTargets);
  EXPECT_NEAR(table_->values()[0] / (limit / kTargets), 1, 1e-5);
  EXPECT_NEAR(table_->values()[1] / (limit / kTargets), 1, 1e-6);
  record("131,072 targets of 1e30 in one frame", fmt::format("value {:.7g}, all counted", limit / kTargets),
         fmt::format("value {:.7g}, {} counted", table_->values()[0], noticed));
}

}  // namespace
}  // namespace qtrace::test
