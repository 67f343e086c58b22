// What a reference's hash depends on, and which files can serve.
#include "experiments/reference.h"
#include "engine/core/check.h"
#include "experiments/exr.h"
#include "tests/system/temp_folder.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace qtrace::experiments {
namespace {

RunConfig small_config() {
  RunConfig config;
  config.render.width = 2;
  config.render.height = 1;
  config.reference.frames = 4;
  return config;
}

RadianceImage small_image() {
  return {2, 1, 4, {glm::dvec3(1), glm::dvec3(2)}, {glm::dvec3(0.5), glm::dvec3(0.5)}};
}

std::string hash_of(const RunConfig& config, const std::string& scene = "scene") {
  return reference_spec(config, scene).hash;
}

TEST(Reference, NeverLearns) {
  RunConfig config = small_config();
  config.render.sampler = Sampler::rl;
  config.render.nee = Nee::none;
  const ReferenceSpec spec = reference_spec(config, "scene");
  EXPECT_EQ(spec.settings.sampler, Sampler::bsdf);
  EXPECT_EQ(spec.settings.nee, Nee::one_ray);
  EXPECT_EQ(spec.settings.seed, config.reference.seed);
  EXPECT_EQ(spec.hash.size(), 32U);
}

TEST(Reference, NeverClamps) {
  RunConfig config = small_config();
  config.render.clamp_radiance = 3;
  const ReferenceSpec spec = reference_spec(config, "scene");
  EXPECT_EQ(spec.settings.clamp_radiance, 0);
  EXPECT_EQ(spec.definition.at("clamp_radiance"), 0);
}

TEST(Reference, IsSharedByRunsThatEstimateTheSame) {
  const RunConfig config = small_config();
  RunConfig other = config;
  other.name = "another";
  other.scene = "copy.glb";
  other.render.sampler = Sampler::uniform;
  other.render.nee = Nee::two_ray;
  other.render.seed = 77;
  other.render.rl.bins_phi = 3;
  other.render.russian_roulette_start = 5;
  other.render.clamp_radiance = 3;
  other.filter.kind = FilterKind::atrous;
  other.firefly_multiple = 7;
  other.frames = 2;
  EXPECT_EQ(hash_of(config), hash_of(other));
}

TEST(Reference, HashKnowsEverythingThatDefinesTheImage) {
  const RunConfig config = small_config();
  std::vector<RunConfig> others(7, config);
  others[0].render.width = 3;
  others[1].render.height = 3;
  others[2].render.max_bounces = 4;
  others[3].render.environment = {0, 0, 1};
  others[4].reference.frames = 5;
  others[5].reference.seed = 5;
  std::set<std::string> hashes{hash_of(config), hash_of(config, "scenf")};
  for (std::size_t i = 0; i < 6; ++i) hashes.insert(hash_of(others[i]));
  EXPECT_EQ(hashes.size(), 8U);
  EXPECT_EQ(hash_of(config), hash_of(others[6]));
}

class ReferenceFiles : public testing::Test {
 protected:
  std::string error_of(const RadianceImage& image, const std::string& hash) const {
    write_exr(folder_ / "r.exr", to_exr(image, {{"referenceHash", hash}}));
    try {
      read_reference(folder_ / "r.exr", spec_);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  tests::TempFolder folder_;
  ReferenceSpec spec_ = reference_spec(small_config(), "scene");
};

TEST_F(ReferenceFiles, AreReadWithTheirVariance) {
  ASSERT_EQ(error_of(small_image(), spec_.hash), "no error");
  const RadianceImage image = read_reference(folder_ / "r.exr", spec_).image;
  EXPECT_EQ(image.mean[1].y, 2);
  EXPECT_EQ(image.variance[0].x, 0.5);
  EXPECT_EQ(image.samples, 4U);
}

TEST_F(ReferenceFiles, OfOtherHashSizeOrLengthAreRefused) {
  EXPECT_NE(error_of(small_image(), "0123").find("is not the reference"), std::string::npos);
  RadianceImage image = small_image();
  std::swap(image.width, image.height);
  EXPECT_NE(error_of(image, spec_.hash).find("has 1x2 pixels but must have 2x1"), std::string::npos);
  image = small_image();
  image.samples = 3;
  EXPECT_NE(error_of(image, spec_.hash).find("has 3 samples per pixel but must have 4"), std::string::npos);
}

TEST_F(ReferenceFiles, WithNonFinitePixelsAreRefused) {
  RadianceImage image = small_image();
  image.mean[0].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(error_of(image, spec_.hash).find("not finite"), std::string::npos);
}

TEST_F(ReferenceFiles, AreFoundInResultsAndBesideConfigs) {
  const auto exists = [this] {
    return ReferenceStore::exists(spec_, folder_ / "results", folder_ / "configs");
  };
  EXPECT_FALSE(exists());
  const auto shipped = folder_.write("configs/references/" + spec_.hash + ".exr", "");
  EXPECT_TRUE(exists());
  std::filesystem::remove(shipped);
  folder_.write("results/references/" + spec_.hash + ".exr", "");
  EXPECT_TRUE(exists());
}

}  // namespace
}  // namespace qtrace::experiments
