// Fireflies and clamping, in boxes where every sample is known.
#include "engine/core/check.h"
#include "engine/scene/analytic.h"
#include "tests/support/render.h"

#include <gtest/gtest.h>

#include <limits>

namespace qtrace::test {
namespace {

constexpr int kSize = 8;
constexpr std::size_t kPixels = kSize * kSize;
constexpr int kFrames = 3;

RenderSettings emission_alone() {
  RenderSettings settings;
  settings.random = RandomNumbers::independent;
  settings.width = settings.height = kSize;
  settings.max_bounces = 0;
  settings.sampler = Sampler::bsdf;
  return settings;
}

// Every sample is `emission`.
Scene glowing_box(glm::vec3 emission) {
  Scene scene = furnace_box(0.5F, 1);
  scene.materials[0].emission = emission;
  return scene;
}

TEST(Outliers, SamplesAboveTheirPixelsThresholdAreFireflies) {
  Tracer tracer(device(), glowing_box(glm::vec3(1)), emission_alone());
  std::vector<float> thresholds(kPixels, 1);  // not exceeded
  thresholds[5] = thresholds[17] = thresholds[40] = 0.75F;
  tracer.set_firefly_thresholds(thresholds);
  for (int frame = 0; frame < kFrames; ++frame) {
    tracer.render_frame();
    EXPECT_EQ(tracer.last_frame_counters().fireflies, 3U);
  }
  const Outliers outliers = tracer.outliers();
  EXPECT_EQ(outliers.firefly_sum, 3 * kFrames);
  EXPECT_EQ(outliers.clamped_away, 0);
  ASSERT_EQ(outliers.brightest.size(), 3U);
  const std::uint32_t places[3][2] = {{5, 0}, {1, 2}, {0, 5}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(outliers.brightest[i].x, places[i][0]);
    EXPECT_EQ(outliers.brightest[i].y, places[i][1]);
    EXPECT_EQ(outliers.brightest[i].frame, 1U);  // the first of equals
    EXPECT_EQ(outliers.brightest[i].radiance, 1);
  }
}

TEST(Outliers, WithoutThresholdsNothingIsAFirefly) {
  Tracer tracer(device(), glowing_box(glm::vec3(1e30F)), emission_alone());
  tracer.render_frame();
  EXPECT_EQ(tracer.last_frame_counters().fireflies, 0U);
  EXPECT_TRUE(tracer.outliers().brightest.empty());
}

TEST(Outliers, ThresholdsMustFitAndComeFirst) {
  Tracer tracer(device(), glowing_box(glm::vec3(1)), emission_alone());
  EXPECT_THROW(tracer.set_firefly_thresholds(std::vector<float>(kPixels - 1)), Error);
  tracer.render_frame();
  EXPECT_THROW(tracer.set_firefly_thresholds(std::vector<float>(kPixels)), Error);
}

// The brightest of its pixel, of all frames: found again from the samples themselves.
TEST(Outliers, TheBrightestSampleIsKeptWithItsFrameTheSameEveryTime) {
  RenderSettings settings = emission_alone();
  settings.max_bounces = 2;
  settings.sampler = Sampler::rl;
  settings.rl.sites_per_object = 4;
  const Scene scene = lit_floor(0.5F, 10, 1, 1).scene;
  constexpr int kMoreFrames = 16;
  const auto outliers = [&] {
    Tracer tracer(device(), scene, settings);
    tracer.set_firefly_thresholds(std::vector<float>(kPixels, 1e-6F));
    render(tracer, kMoreFrames);
    return tracer.outliers();
  };
  const Outliers first = outliers();
  const Outliers second = outliers();
  ASSERT_GT(first.brightest.size(), 10U);
  ASSERT_EQ(first.brightest.size(), second.brightest.size());
  EXPECT_EQ(first.firefly_sum, second.firefly_sum);
  Tracer tracer(device(), scene, settings);
  std::vector<double> before(kPixels, 0.0);
  std::vector<std::vector<double>> samples;  // by frame
  for (int frame = 1; frame <= kMoreFrames; ++frame) {
    const RadianceImage image = render(tracer, 1).image;
    std::vector<double>& now = samples.emplace_back();
    for (std::size_t i = 0; i < kPixels; ++i) {
      now.push_back(image.mean[i].g * frame - before[i]);
      before[i] = image.mean[i].g * frame;
    }
  }
  double last = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < first.brightest.size(); ++i) {
    const Firefly& firefly = first.brightest[i];
    EXPECT_EQ(firefly.frame, second.brightest[i].frame);
    EXPECT_EQ(firefly.radiance, second.brightest[i].radiance);
    EXPECT_LE(firefly.radiance, last);
    last = firefly.radiance;
    const std::size_t pixel = firefly.y * kSize + firefly.x;
    EXPECT_NEAR(samples[firefly.frame - 1][pixel], firefly.radiance, 1e-5 * firefly.radiance);
    for (const auto& frame : samples) EXPECT_LE(frame[pixel], firefly.radiance * (1 + 1e-5));
  }
}

TEST(Outliers, ClampingKeepsHueAndSaysWhatItRemoved) {
  RenderSettings settings = emission_alone();
  settings.clamp_radiance = 2;
  Tracer tracer(device(), glowing_box({4, 2, 1}), settings);
  tracer.set_firefly_thresholds(std::vector<float>(kPixels, 2));  // between 7/6 clamped and 7/3 as it came
  for (int frame = 0; frame < kFrames; ++frame) {
    tracer.render_frame();
    EXPECT_EQ(tracer.last_frame_counters().clamped_samples, kPixels);
    EXPECT_EQ(tracer.last_frame_counters().fireflies, kPixels);
  }
  for (const glm::dvec3& pixel : tracer.radiance().mean) EXPECT_EQ(pixel, glm::dvec3(2, 1, 0.5));
  const Outliers outliers = tracer.outliers();
  EXPECT_NEAR(outliers.clamped_away / (kFrames * kPixels), 7.0 / 3 - 3.5 / 3, 1e-12);
  EXPECT_FLOAT_EQ(static_cast<float>(outliers.brightest.at(0).radiance), 7.0F / 3);
}

// What is removed is the whole difference to the same paths unclamped, and out of reach nothing changes.
TEST(Outliers, ClampedPlusRemovedIsTheUnclampedImage) {
  RenderSettings settings = emission_alone();
  settings.max_bounces = 2;
  const Scene scene = lit_floor(0.5F, 10, 1, 1).scene;
  const auto render_with = [&](double clamp_radiance) {
    settings.clamp_radiance = clamp_radiance;
    Tracer tracer(device(), scene, settings);
    const RadianceImage image = render(tracer, 16).image;
    return std::pair(image, tracer.outliers().clamped_away);
  };
  const auto [plain, none] = render_with(0);
  const auto [far, nothing] = render_with(1e30);
  const auto [clamped, removed] = render_with(1);
  EXPECT_EQ(plain.mean, far.mean);
  EXPECT_EQ(plain.variance, far.variance);
  EXPECT_EQ(none, 0);
  EXPECT_EQ(nothing, 0);
  EXPECT_GT(removed, 1);
  double difference = 0;
  for (std::size_t i = 0; i < kPixels; ++i) {
    const glm::dvec3 d = plain.mean[i] - clamped.mean[i];
    difference += 16 * (d.r + d.g + d.b) / 3;
  }
  EXPECT_NEAR(removed / difference, 1, 1e-12);
}

}  // namespace
}  // namespace qtrace::test
