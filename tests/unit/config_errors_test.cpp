// How every wrong config is refused.
#include "engine/core/check.h"
#include "engine/core/text.h"
#include "experiments/runtime/scene_store.h"
#include "tests/support/cpu_time.h"
#include "tests/unit/config_text.h"

#include <gtest/gtest.h>

namespace qtrace::experiments {
namespace {

// The members with numbers in place of "{}", each ending in ", ".
std::string many_members(const std::string& member, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += fmt::format(fmt::runtime(member), i);
  return text;
}

std::string error_of(const std::string& text, const std::vector<std::string>& sets = {}) {
  try {
    load(text, sets);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

struct BadConfig {
  const char* name;
  std::string text;
  const char* message;  // part of it
};

class BadConfigs : public testing::TestWithParam<BadConfig> {};

TEST_P(BadConfigs, AreRefusedWithFileAndKey) {
  const std::string error = error_of(GetParam().text);
  EXPECT_NE(error.find("c.json: "), std::string::npos) << error;
  EXPECT_NE(error.find(GetParam().message), std::string::npos) << error;
}

const BadConfig kBadConfigs[] = {
    {"UnknownKey", config_text(R"("widht": 3, )"), "unknown key 'widht'; did you mean 'width'?"},
    {"UnknownNestedKey", config_text(R"("rl": {"bins_fi": 3}, )"),
     "unknown key 'rl.bins_fi'; did you mean 'rl.bins_phi'?"},
    {"KeyAtTheWrongLevel", config_text(R"("sites_per_object": 3, )"), "did you mean 'rl.sites_per_object'?"},
    {"NothingNear", config_text(R"("qwertyuiop": 3, )"), "`qtrace keys` lists all keys"},
    {"DuplicateKey", config_text(R"("width": 3, "width": 4, )"), "key 'width' stands twice"},
    {"DuplicateNestedKey", config_text(R"("rl": {"bins_phi": 3, "bins_phi": 3}, )"),
     "'bins_phi' stands twice"},
    {"NestedAndDotted", config_text(R"("rl": {"bins_phi": 3}, "rl.bins_phi": 4, )"),
     "'rl.bins_phi' is given twice"},
    {"TextForNumber", config_text(R"("width": "512", )"),
     "key 'width' is \"512\" but must be a whole number from 1 to 16384"},
    {"BoolForNumber", config_text(R"("rl": {"bsdf_fraction": true}, )"),
     "'rl.bsdf_fraction' is true but must be"},
    {"FractionForWhole", config_text(R"("width": 3.5, )"), "'width' is 3.5 but must be a whole number"},
    {"TooSmall", config_text(R"("width": 0, )"), "'width' is 0 but must be a whole number from 1 to 16384"},
    {"TooLarge", config_text(R"("rl": {"bins_theta": 65}, )"),
     "'rl.bins_theta' is 65 but must be a whole number from 1 to 64"},
    {"NumberTooLarge", config_text(R"("rl": {"bsdf_fraction": 1.5}, )"),
     "'rl.bsdf_fraction' is 1.5 but must be a number from 0 to 1"},
    {"NegativeSeed", config_text(R"("seed": -1, )"), "'seed' is -1"},
    {"SeedBeyond32Bits", config_text(R"("seed": 4294967296, )"), "'seed' is 4294967296"},
    {"NotANumber", config_text(R"("width": NaN, )"), "not valid JSON"},
    {"BeyondDouble", config_text(R"("rl": {"bsdf_fraction": 1e999}, )"), "not valid JSON"},
    {"Null", config_text(R"("width": null, )"), "'width' is null"},
    {"UnknownSampler", config_text(R"("sampler": "bsfd", )"),
     "'sampler' is \"bsfd\" but must be one of bsdf, uniform, rl; did you mean 'bsdf'?"},
    {"UnknownFilter", config_text(R"("filter": {"kind": "atros"}, )"),
     "'filter.kind' is \"atros\" but must be one of none, atrous; did you mean 'atrous'?"},
    {"FireflyMultipleBelowOne", config_text(R"("firefly_multiple": 0.5, )"),
     "'firefly_multiple' is 0.5 but must be a number from 1 to 1000000000"},
    {"SamplerOfOtherType", config_text(R"("sampler": 1, )"), "must be one of bsdf, uniform, rl"},
    {"TwoChannels", config_text(R"("environment": [1, 2], )"),
     "'environment' is [1,2] but must be a list of 3"},
    {"NegativeChannel", config_text(R"("environment": [1, 2, -3], )"), "'environment[2]' is -3"},
    {"GroupThatIsNone", config_text(R"("rl": 3, )"), "'rl' is 3 but must be an object"},
    {"SnapshotBeyondTheEnd", config_text(R"("snapshots": [9], )"), "frame 9, but the run has only 8 frames"},
    {"SnapshotZero", config_text(R"("snapshots": [0], )"), "'snapshots[0]' is 0"},
    {"SnapshotsInDisorder", config_text(R"("snapshots": [4, 4], )"),
     "must be increasing, but frame 4 follows frame 4"},
    {"SnapshotWord", config_text(R"("snapshots": "all", )"), "\"powers_of_two\" or a list of frames"},
    {"AllWarmup", config_text(R"("warmup_frames": 8, )"),
     "'warmup_frames' is 8 but must be less than 'frames'"},
    {"ReferenceSeed", config_text(R"("seed": 9001, )"), "'seed' and 'reference.seed' are both 9001"},
    {"OddReplicates", config_text(R"("random": "sobol", "replicates": 3, )"),
     "'replicates' is 3 but must be 1 or even"},
    {"VerdictWithoutVariance", config_text(R"("random": "sobol", "expect": {"against": "reference"}, )"),
     "'replicates' is 1 and must be 8 at least"},
    {"TrialOfOddLength", config_text(R"("rl": {"trial_frames": 5}, )"),
     "'rl.trial_frames' is 5 but must be even"},
    {"ReferenceOfOneFrame", config_text(R"("reference": {"frames": 1}, )"), "'reference.frames' is 1"},
    {"NoName", R"({"scene": "a.glb"})", "key 'name' is missing"},
    {"NoScene", R"({"name": "a"})", "key 'scene' is missing"},
    {"NameWithFolder", R"({"name": "../a", "scene": "a.glb"})", "must be a plain file name"},
    {"ReservedName", R"({"name": "references", "scene": "a.glb"})", "where reference images are kept"},
    {"NotAnObject", "[]", "must be a JSON object, not []"},
    {"Truncated", R"({"name": "a")", "not valid JSON: parse error at line 1, column 13"},
    {"Empty", "", "not valid JSON"},
    {"TooDeep", config_text("\"rl\": " + std::string(40, '[') + std::string(40, ']') + ", "),
     "nested more than 16 deep"},
    {"TooLong", config_text(std::string(1 << 20, ' ')), "the config has 1048623 bytes; at most 1048576"},
    {"TooManyKeys", config_text(many_members(R"("k{}": 1, )", 5000)), "an object has more than 4096 keys"},
    {"PublishedText", config_text(R"("published": {"ms_per_frame": {"a": "x"}}, )"),
     "'published.ms_per_frame.a' is \"x\""},
};

INSTANTIATE_TEST_SUITE_P(Config, BadConfigs, testing::ValuesIn(kBadConfigs),
                         [](const auto& test) { return std::string(test.param.name); });

// Found by fuzzing.
TEST(Config, MessagesAreOneLineOfUtf8WhateverTheFileHolds) {
  const std::string long_key(200'000, 'w');
  for (const std::string& text : {std::string("\"\xff\xe2\x82"), config_text(R"("a\nb\u001b[31m": 1, )"),
                                  config_text("\"width\": \"" + std::string(58, 'x') + "\u20ac\u20ac\", "),
                                  config_text("\"" + long_key + "\": 1, ")}) {
    const std::string error = error_of(text);
    EXPECT_NE(error, "no error");
    EXPECT_LT(error.size(), 1200U);
    EXPECT_EQ(one_line(error, 2000), error);
  }
}

// Found beside the fuzzing: 21 s, because the parser looked through the list after each of its objects.
TEST(Config, ManySmallValuesAreReadInSeconds) {
  const double start = test::cpu_seconds();
  const std::string error = error_of(config_text("\"list\": [" + many_members("{{}}, ", 250'000) + "0], "));
  EXPECT_NE(error.find("unknown key 'list'"), std::string::npos) << error;
  EXPECT_LT(test::cpu_seconds() - start, 3);
}

// Found by fuzzing: seconds for 30 kB, as every object on the way to a dotted key was written down for a
// message that nobody read.
TEST(Config, DottedKeysAreReadInNoTime) {
  EXPECT_NE(error_of(config_text("\"a" + std::string(64, '.') + "\": 1, ")).find("has 65 parts; at most 16"),
            std::string::npos);
  std::string members;
  for (int i = 0; i < 4000; ++i) members += fmt::format("\"a.b.c.d.e.f.g.h.i.j.k.l.m.n.o{}\": 1, ", i);
  const double start = test::cpu_seconds();
  EXPECT_NE(error_of(config_text(members)).find("unknown key 'a'"), std::string::npos);
  EXPECT_LT(test::cpu_seconds() - start, 3);
}

TEST(Config, MissingFileAndFolderAreNamed) {
  const tests::TempFolder folder;
  EXPECT_THROW(load_experiment(folder / "none.json"), Error);
  EXPECT_THROW(load_experiment(folder.path()), Error);
  // Found beside the fuzzing: the file system's own exception for a name that is too long.
  EXPECT_THROW(load_experiment(folder / std::string(5000, 'x')), Error);
  EXPECT_THROW(SceneStore().load(folder / std::string(5000, 'x')), Error);
}

TEST(ConfigSet, RefusesWhatItCannotMean) {
  const std::string text =
      config_text(R"("sweep": [{"seed": [1]}, {"m": {"a": {"rl": {"bins_phi": 3}}}}], )");
  EXPECT_EQ(error_of(text, {"framse=3"}), "--set: unknown key 'framse'; did you mean 'frames'?");
  EXPECT_EQ(error_of(text, {"frames"}), "--set frames: must be key=value");
  EXPECT_NE(error_of(text, {"seed=3"}).find("--set seed: the sweep axis 'seed' sets 'seed' too"),
            std::string::npos);
  EXPECT_NE(error_of(text, {"rl.bins_phi=3"}).find("the sweep axis 'm' sets 'rl.bins_phi' too"),
            std::string::npos);
  EXPECT_NE(error_of(text, {"sweep.sed=[1]"}).find("no axis 'sed'; did you mean 'seed'?"), std::string::npos);
  EXPECT_NE(error_of(text, {"frames=0"}).find("key 'frames' is 0"), std::string::npos);
}

}  // namespace
}  // namespace qtrace::experiments
