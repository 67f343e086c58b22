// Whether 95 % intervals hold what they promise, with real renders: a thousand runs of a small image in 200
// groups of five seeds, grouped anew five times. The share of 200 good intervals has a standard error of 1.5
// %. Once with errors that are normally distributed, once with those of a learned table, whose tails are
// heavy. Seconds are those of the processors: of such short runs the clock tells how busy the machine is.
#include "experiments/measure/metrics.h"
#include "experiments/records/ratios.h"

#include "engine/gltf/load_gltf.h"
#include "engine/scene/analytic.h"
#include "tests/support/cpu_time.h"
#include "tests/support/render.h"

#include <gtest/gtest.h>

#include <array>
#include <map>

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

struct Method {
  std::string name;
  Sampler sampler = Sampler::bsdf;
  Nee nee = Nee::none;
  int reference_frames = 0;
  RandomNumbers random = RandomNumbers::independent;
};

Scene scene_of(const Method& method) {
  return method.sampler == Sampler::rl ? load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/occluded.glb")
                                       : lit_floor(0.5F, 10, 4, 3).scene;
}

RenderSettings small_settings(const Method& method, std::uint32_t seed) {
  RenderSettings settings;
  settings.width = settings.height = 32;
  settings.max_bounces = 4;
  settings.sampler = method.sampler;
  settings.nee = method.nee;
  settings.random = method.random;
  settings.rl.trial_frames = 0;  // runs that decide differently are of two kinds: no interval over five holds
  settings.seed = seed;
  return settings;
}

SmallRun render_run(const Scene& scene, const RenderSettings& settings, const RadianceImage& reference) {
  Tracer tracer(test::device(), scene, settings);
  SmallRun run;
  double elapsed = 0;
  for (int frame = 1; frame <= kFrames; ++frame) {
    const double start = test::cpu_seconds();
    tracer.render_frame();
    test::device().finish();
    elapsed += test::cpu_seconds() - start;
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
class Coverage : public testing::TestWithParam<Method> {
 protected:
  // Made once for all figures of a method.
  static const std::vector<SmallRun>& runs() {
    static std::map<std::string, std::vector<SmallRun>> all;
    const Method& method = GetParam();
    std::vector<SmallRun>& runs = all[method.name];
    if (!runs.empty()) return runs;
    const Scene scene = scene_of(method);
    RenderSettings truth = small_settings(method, 90'000);
    truth.sampler = Sampler::bsdf;
    const RadianceImage reference = test::render(scene, truth, method.reference_frames).image;
    for (int i = 0; i < kGroups * kSeeds; ++i) {
      runs.push_back(render_run(scene, small_settings(method, static_cast<std::uint32_t>(i + 1)), reference));
    }
    return runs;
  }

  // One run of each fifth of them; `shift` makes other groups of the same runs.
  static std::vector<SmallRun> group(int index, int shift) {
    std::vector<SmallRun> members;
    for (int i = 0; i < kSeeds; ++i) {
      members.push_back(runs()[static_cast<std::size_t>((index + i * shift) % kGroups + i * kGroups)]);
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
    printf("coverage of the %s, %s: %.1f %%\n", figure.c_str(), GetParam().name.c_str(), 100 * share);
    EXPECT_GE(share, 0.92) << figure;
    EXPECT_LE(share, 0.98) << figure;
  }

  static void expect_mean_covered(const std::string& figure, double SmallRun::*value) {
    double truth = 0;
    for (const SmallRun& run : runs()) truth += run.*value / static_cast<double>(runs().size());
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
};

TEST_P(Coverage, MeanRadiance) { expect_mean_covered("mean", &SmallRun::mean); }

TEST_P(Coverage, Mse) { expect_mean_covered("mse", &SmallRun::mse); }

TEST_P(Coverage, TimeToError) {
  const Curve truth_curve = mean_curve(curves(runs()));
  const double target = truth_curve[4].error * 0.7;  // between 16 and 32 frames
  const double truth = *time_to_error(truth_curve, target);
  expect_covered("time to error", [&](const std::vector<SmallRun>& members) {
    const auto found = time_to_error(curves(members), target);
    return found && found->low && *found->low <= truth && truth <= *found->high;
  });
}

INSTANTIATE_TEST_SUITE_P(
    Methods, Coverage,
    testing::Values(Method{"bsdf", Sampler::bsdf, Nee::none, 4096},
                    Method{"rl", Sampler::rl, Nee::one_ray, 16384},
                    Method{"sobol", Sampler::bsdf, Nee::one_ray, 16384, RandomNumbers::sobol},
                    Method{"rl_sobol", Sampler::rl, Nee::one_ray, 16384, RandomNumbers::sobol}),
    [](const auto& method) { return method.param.name; });

}  // namespace
}  // namespace qtrace::experiments
