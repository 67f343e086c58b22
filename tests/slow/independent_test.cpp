// Every shipped scene, sampler and kind of next event estimation beside the independent tracer, and a file
// that the environment variable QTRACE_INDEPENDENT_FILE names by its whole path. Prints the rows of a table
// that tests/independent/run.py keeps, and on the error stream how far it is.
#include "experiments/runtime/manifest.h"
#include "tests/independent/comparison.h"
#include "tests/support/device.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace qtrace::independent {
namespace {

constexpr double kChance = 1e-4;  // that a true renderer fails one comparison
// Of the mean's ratio. Where the most is not enough, what was reached stands beside it: without next event
// estimation, small lights are found by chance alone.
constexpr double kPrecision = 1e-3;
constexpr int kSize = 128;     // 1024 blocks
constexpr int kSamples = 512;  // of the independent tracer, at least
constexpr int kFrames = 512;

// At most, so that a scene takes some ten minutes on two cores. Small lights that are found by chance need
// most frames. In glossy_room few paths of the independent tracer bring most of what its lobes show (see
// pooled_chi2): beside the mean of eight learned images, its 2048 samples have a chi-square of 1.31 and 2048
// frames of the renderer's BSDF sampling 1.17, but another learned image 1.00. Hence half an hour for that
// scene.
struct Work {
  int samples, frames;
};
Work most_work(const std::string& scene) {
  if (scene == "many_lights.glb") return {2048, 32768};
  if (scene == "glossy_room.glb") return {8192, 4096};
  return {2048, 4096};
}

// Behind the door, chance finds the lamp in so few paths that after 3072 frames the mean is known to 1.6 %,
// and pixels are far from normally distributed: nothing could be told apart. Neither could it where
// directions go uniformly through narrow lobes: after 4096 frames the mean of glossy_room is known to 3 to 22
// %.
// Of a file nobody knows that before: it is compared with next event estimation, as its light may be small
// and its lobes narrow.
bool can_tell(const std::string& scene, Sampler sampler, Nee nee) {
  if (is_file(scene)) return nee == Nee::one_ray && sampler != Sampler::uniform;
  if (scene == "door_ajar.glb") return nee != Nee::none;
  return scene != "glossy_room.glb" || sampler != Sampler::uniform;
}

// What a table calls agreement: of the chi-square per pixel, which 16,384 pixels tell to 0.013. That of
// blocks is told to 0.05 only, so it is judged by its error.
constexpr double kChi2Bound = 0.1, kErrors = 3;

class SlowIndependent : public testing::TestWithParam<const char*> {};

std::vector<const char*> scenes() {
  std::vector<const char*> all(kScenes.begin(), kScenes.end());
  if (const char* file = std::getenv("QTRACE_INDEPENDENT_FILE")) all.push_back(file);
  return all;
}

std::string name_of(const std::string& scene) { return std::filesystem::path(scene).stem().string(); }

// As GoogleTest wants the names of tests.
std::string test_name_of(const std::string& scene) {
  std::string name = name_of(scene);
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

std::string verdict(const Agreement& found) {
  const double errors = std::abs(found.mean_ratio - 1) / found.mean_ratio_error;
  if (!found.agrees(kChance) || std::abs(found.pixels.value - 1) > kChi2Bound) return "**differs**";
  if (errors <= kErrors) {
    return found.mean_ratio_error <= kPrecision
               ? "agrees"
               : fmt::format("agrees, mean to {:.2f} %", 100 * found.mean_ratio_error);
  }
  // Of so many comparisons, some are there by chance.
  return fmt::format("within chance, mean off by {:.1f} errors", errors);
}

void print_row(const std::string& scene, Sampler sampler, Nee nee, const Agreement& found, int samples) {
  fmt::print("| {} | {} | {} | {:.3f} ± {:.3f} | {:.3f} ± {:.3f} | {:.5f} ± {:.5f} | {} | {} | {} |\n",
             name_of(scene), enum_name(sampler), enum_name(nee), found.pixels.value, found.pixels.error,
             found.blocks.value, found.blocks.error, found.mean_ratio, found.mean_ratio_error, found.frames,
             samples, verdict(found));
  std::fflush(stdout);
}

TEST_P(SlowIndependent, EveryMethodAgrees) {
  const auto start = std::chrono::steady_clock::now();
  const auto progress = [&start](const std::string& what) {
    fmt::print(stderr, "{:6.0f} s  {}: {}\n",
               std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
               name_of(GetParam()), what);
  };
  fmt::print("device: {}\n", experiments::device_text(test::device().device()));
  const Work most = most_work(GetParam());
  const Comparison comparison(
      GetParam(),
      {.size = kSize, .samples = kSamples, .most_samples = most.samples, .precision = kPrecision});
  progress(fmt::format("{} samples per pixel of the independent tracer", comparison.samples()));
  for (const Sampler sampler : {Sampler::bsdf, Sampler::uniform, Sampler::rl}) {
    for (const Nee nee : {Nee::none, Nee::one_ray, Nee::two_ray}) {
      if (!can_tell(GetParam(), sampler, nee)) continue;
      const auto watch = [&](const Agreement& so_far) {
        progress(fmt::format("{} + {}: {}", enum_name(sampler), enum_name(nee), so_far.text()));
      };
      const Agreement found = comparison.measure(sampler, nee, kFrames, most.frames, kPrecision, watch);
      print_row(GetParam(), sampler, nee, found, comparison.samples());
      EXPECT_TRUE(found.agrees(kChance)) << found.text();
      EXPECT_NEAR(found.pixels.value, 1, kChi2Bound) << found.text();
      EXPECT_EQ(found.non_finite, 0U);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SlowIndependent, testing::ValuesIn(scenes()),
                         [](const auto& scene) { return test_name_of(scene.param); });

}  // namespace
}  // namespace qtrace::independent
