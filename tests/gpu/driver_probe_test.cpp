// What is found out about a driver, beside what a shader of a test's own does on it.
#include "engine/device_scene/driver_measurement.h"
#include "engine/gpu/driver_probe.h"
#include "engine/gpu/llvmpipe.h"
#include "tests/support/probe.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace qtrace::test {
namespace {

// One loop of so many turns, the number of them unknown to the compiler.
std::uint32_t turns_of(std::uint32_t asked) {
  const std::string body = fmt::format(
      "uint end = {}u + index, x = index, turns = 0u;\n"
      "for (uint i = 0u; i < end; ++i) {{ x = (x ^ (x >> 3)) * 1664525u; ++turns; }}\n"
      "result = x == 7u ? 0u : turns;",
      asked);
  return probe<std::uint32_t>("uint", {"shared/structs.glsl"}, "", body, 1)[0];
}

TEST(DriverProbe, LoopLimitIsWhereLoopsEnd) {
  const std::uint32_t limit = device().device().loop_limit;
  EXPECT_EQ(gpu::probe_loop_limit(), limit);
  constexpr std::uint32_t kMany = 200000;
  EXPECT_EQ(turns_of(1000), 1000U);
  if (limit == 0) {
    EXPECT_EQ(turns_of(kMany), kMany);
  } else {
    EXPECT_NEAR(turns_of(kMany), limit, 2);
  }
}

// llvmpipe alone is known to; the probe may miss it on a busy machine, and must not see it anywhere else.
TEST(DriverProbe, OneThreadSplitsNothing) {
  device();  // a context
  EXPECT_FALSE(gpu::splits_by_place(1));
  if (!gpu::is_llvmpipe()) {
    EXPECT_FALSE(gpu::splits_by_place(2));
  }
}

TEST(DriverMeasurement, ChoosesAmongAllWaysAndLeavesTheContextAsItWas) {
  const gpu::DriverChoices before = device().device().choices;
  const gpu::DriverMeasurement measured = gpu::measure_driver(device());
  EXPECT_EQ(device().device().choices, before);
  EXPECT_EQ(gpu::driver_choices(), before);
  // All kinds of fetching that are offered, and the other stack: none answered otherwise.
  const std::size_t ways = (gpu::offers(gpu::Fetch::image) ? 3U : 2U) + 1U;
  EXPECT_EQ(measured.ways.size(), ways);
  for (const gpu::MeasuredWay& way : measured.ways) EXPECT_GT(way.milliseconds, 0);
  EXPECT_TRUE(std::ranges::any_of(
      measured.ways, [&](const gpu::MeasuredWay& way) { return way.choices == measured.best; }));
}

}  // namespace
}  // namespace qtrace::test
