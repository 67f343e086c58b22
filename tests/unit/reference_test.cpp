// What a reference's hash depends on, and which files can serve.
#include "engine/core/check.h"
#include "experiments/images/exr.h"
#include "experiments/images/exr_images.h"
#include "experiments/reference/reference_store.h"
#include "tests/system/temp_folder.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace qtrace::experiments {
namespace {

RunConfig small_config() {
  RunConfig config;
  config.reference.random = RandomNumbers::independent;
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

TEST(Reference, SamplesLightsAsItIsTold) {
  RunConfig config = small_config();
  config.reference.nee = Nee::none;
  config.reference.lights = LightChoice::uniform;
  const ReferenceSpec spec = reference_spec(config, "scene");
  EXPECT_EQ(spec.settings.nee, Nee::none);
  EXPECT_EQ(spec.settings.lights, LightChoice::uniform);
}

// Whatever the run's roulette is.
TEST(Reference, HasARouletteOfItsOwn) {
  RunConfig config = small_config();
  config.render.russian_roulette_start = 0;
  config.reference.random = RandomNumbers::independent;
  EXPECT_EQ(reference_spec(config, "scene").settings.russian_roulette_start, 3);
  config.reference.random = RandomNumbers::sobol;
  EXPECT_EQ(reference_spec(config, "scene").settings.russian_roulette_start, 8);
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
  other.reference.frames = 9;  // how long it is: the same one, extended
  other.reference.relative_error = 0.5;
  other.reference.max_frames = 10;
  EXPECT_EQ(hash_of(config), hash_of(other));
}

TEST(Reference, HashKnowsEverythingThatDefinesTheImage) {
  const RunConfig config = small_config();
  std::vector<RunConfig> others(7, config);
  others[0].render.width = 3;
  others[1].render.height = 3;
  others[2].render.max_bounces = 4;
  others[3].render.environment = {0, 0, 1};
  others[4].reference.nee = Nee::none;
  others[5].reference.seed = 5;
  std::set<std::string> hashes{hash_of(config), hash_of(config, "scenf")};
  for (std::size_t i = 0; i < 6; ++i) hashes.insert(hash_of(others[i]));
  EXPECT_EQ(hashes.size(), 8U);
  EXPECT_EQ(hash_of(config), hash_of(others[6]));
}

TEST(ReferenceWish, IsAboutLengthAndNoise) {
  const ReferenceNoise noise{0, 0.25};  // a relative error of 0.5
  const ReferenceWish length{8, 0, 10};
  EXPECT_FALSE(length.met(7, noise));
  EXPECT_TRUE(length.met(8, noise));
  const ReferenceWish quiet{8, 0.5, 10};
  EXPECT_FALSE(quiet.met(7, noise));
  EXPECT_TRUE(quiet.met(8, noise));
  const ReferenceWish quieter{8, 0.49, 10};
  EXPECT_FALSE(quieter.met(100, noise));
  EXPECT_FALSE(quieter.settled(9, noise));
  EXPECT_TRUE(quieter.settled(10, noise));
}

TEST(ReferenceWish, LooksAtMultiplesThatDoNotDependOnThePast) {
  const ReferenceWish wish{20, 0.1, 100};
  EXPECT_EQ(wish.next_look(0), 20);
  EXPECT_EQ(wish.next_look(20), 20);
  EXPECT_EQ(wish.next_look(21), 32);
  EXPECT_EQ(wish.next_look(32), 32);
  EXPECT_EQ(wish.next_look(33), 48);
  EXPECT_EQ(wish.next_look(97), 100);
  const ReferenceWish length{20, 0, 100};
  EXPECT_EQ(length.next_look(0), 20);
  EXPECT_EQ(length.next_look(21), 21);
}

// A whole number of points for each of 16 replicates; looked at where that is a power of two, or half as many
// again.
TEST(ReferenceWish, LooksAtWholeNetsOfSobolPoints) {
  RunConfig config = small_config();
  config.reference.random = RandomNumbers::sobol;
  config.reference.frames = 20;
  config.reference.relative_error = 0.1;
  config.reference.max_frames = 500;
  const ReferenceSpec spec = reference_spec(config, "scene");
  EXPECT_EQ(spec.settings.replicates, 16);
  EXPECT_EQ(spec.wish.frames, 32);
  EXPECT_EQ(spec.wish.max_frames, 512);
  std::vector<int> looks;
  for (int frame = 0; frame < 512; ++frame) {
    const int look = spec.wish.next_look(frame);
    EXPECT_GE(look, frame);
    if (looks.empty() || looks.back() != look) looks.push_back(look);
  }
  EXPECT_EQ(looks, (std::vector<int>{32, 48, 64, 96, 128, 192, 256, 384, 512}));
}

TEST(Reference, OfSobolPointsIsAnother) {
  RunConfig config = small_config();
  const std::string independent = hash_of(config);
  config.render.random = RandomNumbers::sobol;
  config.render.replicates = 4;
  EXPECT_EQ(hash_of(config), independent) << "what the run draws from is not the reference's";
  config.reference.random = RandomNumbers::sobol;
  EXPECT_NE(hash_of(config), independent);
}

TEST(ReferenceWish, OfTwoRunsServesBoth) {
  const ReferenceWish length{50, 0, 9999};
  const ReferenceWish noise{8, 0.5, 64};
  for (const ReferenceWish& both : {length.joined(noise), noise.joined(length)}) {
    EXPECT_EQ(both.frames, 50);
    EXPECT_EQ(both.relative_error, 0.5);
    EXPECT_EQ(both.max_frames, 64);
  }
  EXPECT_EQ(noise.joined({8, 0.25, 32}).relative_error, 0.25);
  EXPECT_EQ(noise.joined({8, 0.25, 32}).max_frames, 64);
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

TEST_F(ReferenceFiles, OfOtherHashOrSizeAreRefused) {
  EXPECT_NE(error_of(small_image(), "0123").find("is not the reference"), std::string::npos);
  RadianceImage image = small_image();
  std::swap(image.width, image.height);
  EXPECT_NE(error_of(image, spec_.hash).find("has 1x2 pixels but must have 2x1"), std::string::npos);
  image = small_image();
  image.samples = 3;  // too few for the wish, but to be extended
  EXPECT_EQ(error_of(image, spec_.hash), "no error");
  image.samples = 1;
  EXPECT_NE(error_of(image, spec_.hash).find("has 1 samples per pixel but must have 2"), std::string::npos);
}

TEST_F(ReferenceFiles, WithNonFinitePixelsAreRefused) {
  RadianceImage image = small_image();
  image.mean[0].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(error_of(image, spec_.hash).find("not finite"), std::string::npos);
}

TEST_F(ReferenceFiles, AreFoundInResultsAndBesideConfigs) {
  const auto outlook = [this] {
    return ReferenceStore::outlook(spec_, folder_ / "results", folder_ / "configs");
  };
  const auto keep = [this](const std::string& place, std::uint64_t samples) {
    const std::filesystem::path file = folder_.write(place + "/references/" + spec_.hash + ".exr", "damaged");
    if (samples == 0) return;
    RadianceImage image = small_image();
    image.samples = samples;
    write_exr(file, to_exr(image, {{"referenceHash", spec_.hash}}));
  };
  EXPECT_FALSE(outlook().enough);
  EXPECT_EQ(outlook().frames, 0);
  keep("configs", 4);
  EXPECT_TRUE(outlook().enough);
  EXPECT_EQ(outlook().frames, 4);
  keep("results", 7);
  EXPECT_EQ(outlook().frames, 7);
  keep("results", 3);  // too short
  EXPECT_EQ(outlook().frames, 4);
  keep("results", 0);
  EXPECT_EQ(outlook().frames, 4);
  keep("configs", 3);
  EXPECT_FALSE(outlook().enough);
}

}  // namespace
}  // namespace qtrace::experiments
