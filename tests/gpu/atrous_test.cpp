// The à-trous filter against a slow one in double precision, and what it must leave alone.
#include "engine/tracer/atrous.h"
#include "engine/core/check.h"
#include "tests/gpu/slow_filter.h"
#include "tests/support/device.h"

#include <gtest/gtest.h>
#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace qtrace::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A grey wall that faces the viewer, pixels one unit apart.
FirstHitImage wall(int width, int height) {
  FirstHitImage image{width, height, {}, {}, {}, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.normal.emplace_back(0, 0, 1);
      image.position.emplace_back(x, y, 0);
      image.albedo.emplace_back(0.5F);
      image.emission.emplace_back(0);
    }
  }
  return image;
}

RadianceImage constant(const FirstHitImage& hits, glm::dvec3 value) {
  return {hits.width, hits.height, 4, std::vector<glm::dvec3>(hits.normal.size(), value), {}};
}

RadianceImage filtered(const FirstHitImage& hits, const RadianceImage& image,
                       const FilterSettings& settings = {}) {
  return AtrousFilter(device(), hits, settings).apply(image);
}

void expect_near(const glm::dvec3& value, const glm::dvec3& expected, double tolerance) {
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(value[c], expected[c], tolerance * std::max(1e-30, std::abs(expected[c])));
  }
}

// Everything at random: surfaces, lights, misses, black channels and broken pixels.
void make_random(FirstHitImage& hits, RadianceImage& image, std::mt19937& random) {
  std::uniform_real_distribution<float> unit(0, 1);
  for (std::size_t i = 0; i < hits.normal.size(); ++i) {
    hits.normal[i] = glm::normalize(glm::vec3(unit(random), unit(random), 2));
    hits.position[i] += glm::vec3(100, 200, 3 * unit(random));
    hits.albedo[i] = glm::vec3(unit(random), unit(random), unit(random) < 0.3F ? 0 : 1);
    image.mean[i] = glm::dvec3(unit(random), unit(random), unit(random)) * 7.0;
    const float kind = unit(random);
    if (kind < 0.1F)
      hits.emission[i] = glm::vec3(5);
    else if (kind < 0.2F)
      hits.normal[i] = hits.position[i] = hits.albedo[i] = glm::vec3(0);
    else if (kind < 0.25F)
      image.mean[i].y = kNan;
  }
}

TEST(Atrous, AgreesWithTheSlowFilter) {
  std::mt19937 random(7);
  for (int round = 0; round < 4; ++round) {
    SCOPED_TRACE(round);
    FirstHitImage hits = wall(37, 21);
    RadianceImage image = constant(hits, glm::dvec3(0));
    make_random(hits, image, random);
    FilterSettings settings;
    settings.iterations = 1 + round;
    settings.sigma_radiance = 3;
    settings.sigma_normal = 0.4;
    settings.sigma_position = 0.5;
    const std::vector<glm::dvec3> expected = slow_atrous(hits, image, settings);
    const RadianceImage result = filtered(hits, image, settings);
    EXPECT_EQ(result.samples, image.samples);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      SCOPED_TRACE(i);
      if (std::isnan(expected[i].y))
        EXPECT_TRUE(std::isnan(result.mean[i].y));
      else
        expect_near(result.mean[i], expected[i], 1e-4);
    }
  }
}

TEST(Atrous, AConstantImageStaysConstant) {
  const FirstHitImage hits = wall(40, 24);
  const glm::dvec3 value(1e-3, 2e-3, 5);
  for (const glm::dvec3& pixel : filtered(hits, constant(hits, value)).mean) expect_near(pixel, value, 1e-5);
  for (const glm::dvec3& pixel : filtered(hits, constant(hits, glm::dvec3(0))).mean)
    EXPECT_EQ(pixel, glm::dvec3(0));
}

TEST(Atrous, NoiseOnAWallLosesItsVarianceAndKeepsItsMean) {
  const FirstHitImage hits = wall(64, 64);
  RadianceImage image = constant(hits, glm::dvec3(0));
  std::mt19937 random(3);
  std::exponential_distribution<double> noise(1);
  for (glm::dvec3& pixel : image.mean) pixel = glm::dvec3(noise(random), noise(random), noise(random));
  const auto moments = [](const RadianceImage& of) {
    double sum = 0;
    double squares = 0;
    for (const glm::dvec3& pixel : of.mean) {
      sum += pixel.g;
      squares += pixel.g * pixel.g;
    }
    const auto n = static_cast<double>(of.pixels());
    return std::pair(sum / n, squares / n - sum / n * sum / n);
  };
  const auto [mean, variance] = moments(image);
  const auto [new_mean, new_variance] = moments(filtered(hits, image));
  EXPECT_NEAR(new_mean / mean, 1, 0.01);
  EXPECT_LT(new_variance, variance / 50);
}

// Left and right half differ in radiance and in one guide; that guide alone must keep them apart.
class AtrousEdge : public testing::Test {
 protected:
  AtrousEdge() { settings_.sigma_radiance = 1e6; }

  // The halves' radiance before equals that afterwards.
  void expect_sharp(glm::dvec3 left, glm::dvec3 right) {
    RadianceImage image = constant(hits_, left);
    for_right([&](std::size_t i) { image.mean[i] = right; });
    const RadianceImage result = filtered(hits_, image, settings_);
    for (std::size_t i = 0; i < image.mean.size(); ++i) expect_near(result.mean[i], image.mean[i], 1e-5);
  }

  template <class Action>
  void for_right(Action action) {
    for (std::size_t i = 0; i < hits_.normal.size(); ++i) {
      if (i % kWidth >= kWidth / 2) action(i);
    }
  }

  static constexpr std::size_t kWidth = 32;
  FirstHitImage hits_ = wall(kWidth, 8);
  FilterSettings settings_;
};

TEST_F(AtrousEdge, WithoutOneTheHalvesMix) {
  RadianceImage image = constant(hits_, glm::dvec3(1));
  for_right([&](std::size_t i) { image.mean[i] = glm::dvec3(3); });
  EXPECT_GT(filtered(hits_, image, settings_).mean[kWidth / 2 - 1].g, 1.5);
}

TEST_F(AtrousEdge, NormalsKeepApart) {
  for_right([&](std::size_t i) { hits_.normal[i] = glm::vec3(1, 0, 0); });
  expect_sharp(glm::dvec3(1), glm::dvec3(3));
}

TEST_F(AtrousEdge, PositionsKeepApart) {
  for_right([&](std::size_t i) { hits_.position[i].z = 100; });
  expect_sharp(glm::dvec3(1), glm::dvec3(3));
}

TEST_F(AtrousEdge, RadianceKeepsApart) {
  settings_.sigma_radiance = 0.1;
  expect_sharp(glm::dvec3(1), glm::dvec3(3));
}

TEST_F(AtrousEdge, TexturesUnderEqualLightStaySharp) {
  for_right([&](std::size_t i) { hits_.albedo[i] = glm::vec3(0.25F, 0.5F, 0.75F); });
  expect_sharp(glm::dvec3(2), glm::dvec3(1, 2, 3));
}

// Under equal light; the black channels know nothing of it.
TEST_F(AtrousEdge, ChannelsWithoutAlbedoDoNotDarkenTheirNeighbours) {
  for_right([&](std::size_t i) { hits_.albedo[i] = glm::vec3(1, 0, 0); });
  expect_sharp(glm::dvec3(2), glm::dvec3(4, 0, 0));
}

TEST_F(AtrousEdge, LightsMissesAndBrokenPixelsStayAndLeakNothing) {
  for_right([&](std::size_t i) { hits_.emission[i] = glm::vec3(1, 0, 0); });
  expect_sharp(glm::dvec3(1), glm::dvec3(1e6));
  hits_ = wall(kWidth, 8);
  for_right([&](std::size_t i) { hits_.normal[i] = hits_.position[i] = hits_.albedo[i] = glm::vec3(0); });
  expect_sharp(glm::dvec3(1), glm::dvec3(3));
  hits_ = wall(kWidth, 8);
  RadianceImage image = constant(hits_, glm::dvec3(1));
  image.mean[100].r = kNan;
  image.mean[101].b = std::numeric_limits<double>::infinity();
  const RadianceImage result = filtered(hits_, image, settings_);
  for (std::size_t i = 0; i < image.mean.size(); ++i) {
    if (i != 100 && i != 101) expect_near(result.mean[i], glm::dvec3(1), 1e-5);
  }
  EXPECT_TRUE(std::isnan(result.mean[100].r));
  EXPECT_TRUE(std::isinf(result.mean[101].b));
}

TEST(Atrous, UnitsOfLengthAndLightDoNotMatter) {
  std::mt19937 random(5);
  FirstHitImage hits = wall(24, 16);
  RadianceImage image = constant(hits, glm::dvec3(0));
  make_random(hits, image, random);
  FilterSettings settings;
  settings.sigma_position = 1;
  const RadianceImage before = filtered(hits, image, settings);
  for (glm::vec3& position : hits.position) position *= 1024.0F;
  for (glm::dvec3& pixel : image.mean) pixel *= 1e6;
  const RadianceImage after = filtered(hits, image, settings);
  for (std::size_t i = 0; i < image.mean.size(); ++i) {
    if (!std::isnan(image.mean[i].y)) expect_near(after.mean[i], before.mean[i] * 1e6, 1e-5);
  }
}

TEST(Atrous, OtherSizesAreRefused) {
  AtrousFilter filter(device(), wall(4, 2), {});
  EXPECT_THROW(filter.apply(constant(wall(2, 4), glm::dvec3(1))), Error);
}

}  // namespace
}  // namespace qtrace::test
