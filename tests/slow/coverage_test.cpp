// Whether 95 % intervals hold what they promise, with real renders: a thousand runs of one small scene in 200
// groups of five seeds, grouped anew five times. The share of 200 good intervals has a standard error of 1.5
// %.
#include "experiments/metrics.h"
#include "experiments/ratios.h"

#include "engine/scene/analytic.h"
#include "tests/support/render.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>

namespace qtrace::experiments {
namespace {

constexpr int kGroups = 200;
constexpr int kSeeds = 5;
constexpr int kFrames = 32;
constexpr std::array<int, 5> kShifts{0, 7, 31, 73, 117};

struct SmallRun {
  double mean = 0;  // radiance over pixels and channels
  double mse = 0;
  Curve curve;  // of the MSE
};

double mean_radiance(const RadianceImage& image) {
  double sum = 0;
  for (const glm::dvec3& pixel : image.mean) sum += (pixel.x + pixel.y + pixel.z) / 3;
  return sum / static_cast<double>(image.pixels());
}

RenderSettings small_settings(std::uint32_t seed) {
  RenderSettings settings;
  settings.width = settings.height = 32;
  settings.max_bounces = 4;
  settings.sampler = Sampler::bsdf;
  settings.nee = Nee::none;
  settings.seed = seed;
  return settings;
}

SmallRun render_run(const Scene& scene, const RadianceImage& reference, std::uint32_t seed) {
  Tracer tracer(test::device(), scene, small_settings(seed));
  SmallRun run;
  double elapsed = 0;
  for (int frame = 1; frame <= kFrames; ++frame) {
    const auto start = std::chrono::steady_clock::now();
    tracer.render_frame();
    test::device().finish();
    elapsed += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if ((frame & (frame - 1)) != 0) continue;  // snapshots at powers of two
    const RadianceImage image = tracer.radiance();
    run.mse = compare_images(image, reference).mse;
    run.mean = mean_radiance(image);
    run.curve.push_back({static_cast<double>(frame), elapsed, run.mse, false});
  }
  return run;
}

// Runs in the order of their seeds; group g has the runs g, g + 200, g + 400, ... so that a machine that
// drifts does so within every group, as in an experiment.
class Coverage : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const Scene scene = lit_floor(0.5F, 10, 4, 3).scene;
    const RadianceImage reference = test::render(scene, small_settings(90'000), 4096).image;
    for (int i = 0; i < kGroups * kSeeds; ++i) {
      runs_.push_back(render_run(scene, reference, static_cast<std::uint32_t>(i + 1)));
    }
  }

  // One run of each fifth of them; `shift` makes other groups of the same runs.
  static std::vector<SmallRun> group(int index, int shift) {
    std::vector<SmallRun> members;
    for (int i = 0; i < kSeeds; ++i) {
      members.push_back(runs_[static_cast<std::size_t>((index + i * shift) % kGroups + i * kGroups)]);
    }
    return members;
  }

  // Counts the groups whose interval holds the truth.
  template <class Holds>
  static void expect_covered(const std::string& figure, Holds holds) {
    int hits = 0;
    for (const int shift : kShifts) {
      for (int i = 0; i < kGroups; ++i) hits += holds(group(i, shift)) ? 1 : 0;
    }
    const double share = hits / static_cast<double>(kGroups * kShifts.size());
    RecordProperty("coverage_" + figure, std::to_string(share));
    printf("coverage of the %s: %.1f %%\n", figure.c_str(), 100 * share);
    EXPECT_GE(share, 0.92) << figure;
    EXPECT_LE(share, 0.98) << figure;
  }

  static void expect_mean_covered(const std::string& figure, double SmallRun::*value) {
    double truth = 0;
    for (const SmallRun& run : runs_) truth += run.*value / static_cast<double>(runs_.size());
    expect_covered(figure, [&](const std::vector<SmallRun>& members) {
      std::vector<double> values;
      for (const SmallRun& run : members) values.push_back(run.*value);
      const Estimate found = *estimate(values);
      return *found.low <= truth && truth <= *found.high;
    });
  }

  static std::vector<Curve> curves(const std::vector<SmallRun>& runs) {
    std::vector<Curve> result;
    for (const SmallRun& run : runs) result.push_back(run.curve);
    return result;
  }

  inline static std::vector<SmallRun> runs_;
};

TEST_F(Coverage, MeanRadiance) { expect_mean_covered("mean", &SmallRun::mean); }

TEST_F(Coverage, Mse) { expect_mean_covered("mse", &SmallRun::mse); }

TEST_F(Coverage, TimeToError) {
  const Curve truth_curve = mean_curve(curves(runs_));
  const double target = truth_curve[4].error * 0.7;  // between 16 and 32 frames
  const double truth = *time_to_error(truth_curve, target);
  expect_covered("time to error", [&](const std::vector<SmallRun>& members) {
    const auto found = time_to_error(curves(members), target);
    return found && found->low && *found->low <= truth && truth <= *found->high;
  });
}

}  // namespace
}  // namespace qtrace::experiments
