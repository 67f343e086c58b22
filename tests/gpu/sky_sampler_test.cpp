// Chi-squared: directions towards an image of the environment are drawn in proportion to the density that is
// stated.
#include "engine/accel/build_bvh.h"
#include "engine/device_scene/scene_buffers.h"
#include "engine/scene/analytic.h"
#include "engine/tracer/parameters.h"
#include "tests/support/probe.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace qtrace::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::uint32_t kSamples = 1 << 18;
constexpr std::uint32_t kParts = 4;  // of a texel, along each side, equal in longitude and in height

EnvironmentMap random_sky(std::uint32_t width, std::uint32_t height, float rotation) {
  std::mt19937 random(3);
  std::exponential_distribution<float> law(1);
  EnvironmentMap map{width, height, {}, rotation};
  for (std::uint32_t i = 0; i < width * height; ++i) {
    map.radiance.emplace_back(law(random), law(random), law(random));
  }
  return map;
}

std::vector<EnvironmentMap> skies() {
  EnvironmentMap sun = random_sky(12, 6, 0.7F);
  sun.radiance[17] = glm::vec3(900, 400, 100);
  EnvironmentMap at_the_pole = random_sky(8, 5, -2.5F);
  at_the_pole.radiance[3] = glm::vec3(300);
  return {sun, at_the_pole, random_sky(2, 1, 0), random_sky(2, 7, 3), random_sky(1, 4, 1)};
}

// Parts of texels, as EnvironmentMap and the rotation place them.
class Parts {
 public:
  explicit Parts(const EnvironmentMap& map) : map_(map) {}

  std::size_t count() const { return std::size_t{kParts} * kParts * map_.width * map_.height; }

  std::size_t of(const glm::dvec3& d) const {
    double u = (std::atan2(d.x, -d.z) + double{map_.rotation}) / (2 * kPi) + 0.5;
    u -= std::floor(u);
    const double v = std::acos(std::clamp(d.y, -1.0, 1.0)) / kPi;
    const auto column =
        std::min(static_cast<std::uint32_t>(u * map_.width * kParts), map_.width * kParts - 1);
    const auto row = std::min(static_cast<std::uint32_t>(v * map_.height), map_.height - 1);
    const double within = (height_of(row) - d.y) / (height_of(row) - height_of(row + 1)) * kParts;
    const auto part = static_cast<std::uint32_t>(std::clamp(within, 0.0, kParts - 0.5));
    return std::size_t{row * kParts + part} * map_.width * kParts + column;
  }

  glm::dvec3 middle_of(std::size_t part) const {
    const std::size_t line = part / (std::size_t{map_.width} * kParts);
    const std::size_t column = part % (std::size_t{map_.width} * kParts);
    const auto row = static_cast<double>(line / kParts);
    const double y =
        std::lerp(height_of(row), height_of(row + 1), (static_cast<double>(line % kParts) + 0.5) / kParts);
    const double turn = (static_cast<double>(column) + 0.5) / (map_.width * kParts) - 0.5;
    const double phi = 2 * kPi * turn - double{map_.rotation};
    const double r = std::sqrt(1 - y * y);
    return {r * std::sin(phi), y, -r * std::cos(phi)};
  }

  double solid_angle(std::size_t part) const {
    const auto row = static_cast<double>(part / (std::size_t{map_.width} * kParts) / kParts);
    return 2 * kPi * (height_of(row) - height_of(row + 1)) / (map_.width * kParts * kParts);
  }

 private:
  double height_of(double row) const { return std::cos(kPi * row / map_.height); }

  const EnvironmentMap& map_;
};

// The sky on the device, under which nothing stands.
class SkyStage {
 public:
  explicit SkyStage(const EnvironmentMap& map)
      : scene_(under(map)), buffers_(scene_, build_bvh(scene_, BvhKind::sah)) {
    const gpu::Parameters parameters = make_parameters(scene_.camera, {}, buffers_.features(), nullptr);
    block_.write(0, &parameters, sizeof(parameters));
    block_.bind_uniform(gpu::BINDING_PARAMETERS);
    buffers_.bind();
  }

  std::vector<glm::vec4> probed(const std::string& body, std::uint32_t count) const {
    return probe<glm::vec4>("vec4", {"shared/variants.glsl", "sampling/random.glsl", "light/sky.glsl"}, "",
                            body, count, {{"HAS_SKY", "1"}});
  }

 private:
  static Scene under(const EnvironmentMap& map) {
    Scene scene = lit_floor(0.8F, 10, 1, 1).scene;
    scene.environment = map;
    return scene;
  }

  Scene scene_;
  gpu::SceneBuffers buffers_;
  gpu::Buffer block_{"parameters", sizeof(gpu::Parameters)};
};

// Of the direction in the middle of every part.
std::vector<double> densities(const SkyStage& stage, const Parts& parts) {
  std::string directions;
  for (std::size_t i = 0; i < parts.count(); ++i) {
    const glm::dvec3 d = parts.middle_of(i);
    directions += (i > 0 ? ", vec3(" : "vec3(") + std::to_string(d.x) + ", " + std::to_string(d.y) + ", " +
                  std::to_string(d.z) + ")";
  }
  const auto count = static_cast<std::uint32_t>(parts.count());
  std::vector<double> all;
  for (const glm::vec4& v : stage.probed("const vec3 directions[" + std::to_string(count) + "] = vec3[](" +
                                             directions + ");\nresult = vec4(sky_pdf(directions[index]));",
                                         count)) {
    all.push_back(double{v.x});
  }
  return all;
}

TEST(SkySampler, DrawsWhatItStates) {
  device();
  for (const EnvironmentMap& map : skies()) {
    SCOPED_TRACE(std::to_string(map.width) + " x " + std::to_string(map.height));
    const SkyStage stage(map);
    const Parts parts(map);
    std::vector<double> expected = densities(stage, parts);
    double sum = 0;
    for (std::size_t i = 0; i < parts.count(); ++i) {
      expected[i] *= parts.solid_angle(i);
      sum += expected[i];
      expected[i] *= kSamples;
    }
    EXPECT_NEAR(sum, 1, 1e-5);
    std::vector<double> observed(parts.count());
    double wrong_pdf = 0;
    for (const glm::vec4& s :
         stage.probed("SkySample s = sample_sky(random_bits(RandomKey(index, 1u, 9u), 1u).xyz);\n"
                      "result = vec4(s.direction, s.pdf / sky_pdf(s.direction));",
                      kSamples)) {
      EXPECT_NEAR(glm::length(glm::vec3(s)), 1, 1e-5);
      ++observed[parts.of(glm::dvec3(s))];
      if (!(std::abs(s.w - 1) < 1e-3F)) ++wrong_pdf;
    }
    // Rounding may put a direction at a texel's edge into the next one.
    EXPECT_LE(wrong_pdf, 1e-4 * kSamples);
    EXPECT_GT(chi_squared_p(observed, expected), kFalseAlarm / static_cast<double>(skies().size()));
  }
}

}  // namespace
}  // namespace qtrace::test
