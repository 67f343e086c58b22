// Experiments from end to end: files, repeatability, references, failures.
#include "engine/core/settings.h"
#include "tests/system/run_program.h"

#include <cmath>

namespace qtrace::tests {
namespace {

TEST_F(RunProgram, WritesEveryFileOfEveryRun) {
  const Outcome outcome = run("e2e", kMethods);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "device: "));
  EXPECT_TRUE(contains(outcome.err, "run 4/4 method=rl,seed=2: finished"));
  EXPECT_TRUE(contains(outcome.out, "NEE, one ray"));
  EXPECT_EQ(folder_.read("results/e2e/summary.md") + "\nFiles: results/e2e\n", outcome.out);

  const auto summary = parse_csv(folder_.read("results/e2e/summary.csv"));
  ASSERT_EQ(summary.size(), 4U);
  EXPECT_EQ(summary[0].at("axis:method"), "NEE, one ray");
  EXPECT_EQ(summary[3].at("run"), "method=rl,seed=2");
  for (const auto& row : summary) {
    EXPECT_EQ(row.at("status"), "finished");
    EXPECT_EQ(row.at("frames"), "4");
    EXPECT_EQ(row.at("non_finite"), "0");
    EXPECT_GT(std::stod(row.at("host_ms_median")), 0);
    EXPECT_GT(std::stod(row.at("relmse")), 0);
    EXPECT_NEAR(std::stod(row.at("relmse_x_s")), std::stod(row.at("relmse")) * std::stod(row.at("elapsed_s")),
                1e-12);
  }
  for (const auto& row : summary) {
    const std::string base = "results/e2e/" + row.at("run") + "/";
    for (const char* file : {"manifest.json", "frames.csv", "convergence.csv", "first_hit.exr",
                             "frame_000001.exr", "frame_000002.exr", "frame_000004.exr"}) {
      EXPECT_TRUE(std::filesystem::exists(folder_ / (base + file))) << file;
    }
  }
  for (const std::string& name : tree(folder_.path())) EXPECT_FALSE(contains(name, ".tmp")) << name;
}

TEST_F(RunProgram, TablesAndManifestsAgree) {
  ASSERT_EQ(run("agree", kMethods).exit_code, 0);
  const std::string base = "results/agree/method=rl,seed=2/";
  const Json manifest = json(base + "manifest.json");
  EXPECT_EQ(manifest.at("status"), "finished");
  EXPECT_EQ(manifest.at("config").at("sampler"), "rl");
  EXPECT_EQ(manifest.at("config").at("rl").at("bins_phi"), RlSettings{}.bins_phi);
  EXPECT_EQ(manifest.at("axes").at("method"), "RL");
  EXPECT_GT(manifest.at("cells").get<int>(), 0);
  EXPECT_TRUE(manifest.at("device").contains("gl_version"));
  EXPECT_EQ(json("results/agree/manifest.json").at("status"), "finished");
  EXPECT_EQ(json("results/agree/manifest.json").at("runs").size(), 4U);

  const auto frames = parse_csv(folder_.read(base + "frames.csv"));
  ASSERT_EQ(frames.size(), 4U);
  double elapsed = 0;
  for (const auto& row : frames) elapsed += std::stod(row.at("host_ms")) / 1e3;
  EXPECT_EQ(frames[0].at("is_warmup"), "1");
  EXPECT_EQ(frames[1].at("is_warmup"), "0");
  EXPECT_EQ(frames[0].at("paths"), "448") << "not those of the trial's 24 frames of 4 x 4 pixels and its own";
  EXPECT_EQ(frames[1].at("paths"), "64");
  EXPECT_NEAR(std::stod(frames[3].at("elapsed_s")), elapsed, 1e-9);

  const auto curve = parse_csv(folder_.read(base + "convergence.csv"));
  ASSERT_EQ(curve.size(), 3U);
  EXPECT_EQ(curve[2].at("spp"), "4");
  EXPECT_EQ(curve[2].at("elapsed_s"), frames[3].at("elapsed_s"));
  const auto summary = parse_csv(folder_.read("results/agree/summary.csv"));
  EXPECT_EQ(curve[2].at("relmse"), summary[3].at("relmse"));
  EXPECT_EQ(manifest.at("config_hash"), summary[3].at("config_hash"));

  const experiments::ExrImage image = read_exr(folder_ / (base + "frame_000004.exr"));
  EXPECT_EQ(image.metadata.at("spp"), "4");
  EXPECT_EQ(image.metadata.at("seed"), "2");
  EXPECT_EQ(image.metadata.at("configHash"), summary[3].at("config_hash"));
  EXPECT_TRUE(image.channels.contains("variance.B"));
  EXPECT_TRUE(read_exr(folder_ / (base + "first_hit.exr")).channels.contains("normal.Z"));
}

TEST_F(RunProgram, TheSameSeedGivesTheSameBitsAndEarlierResultsAreKept) {
  ASSERT_EQ(run("twice", kMethods).exit_code, 0);
  const Outcome second = run("twice", kMethods, {"--fresh"});
  ASSERT_EQ(second.exit_code, 0);
  EXPECT_TRUE(contains(second.err, "results/twice: earlier results are kept as results/twice.1"))
      << second.err;
  int images = 0;
  for (const std::string& name : tree(folder_ / "results/twice")) {
    if (!name.ends_with(".exr")) continue;
    EXPECT_EQ(folder_.read("results/twice/" + name), folder_.read("results/twice.1/" + name)) << name;
    ++images;
  }
  EXPECT_EQ(images, 16);
  EXPECT_NE(folder_.read("results/twice/method=rl,seed=1/frame_000004.exr"),
            folder_.read("results/twice/method=rl,seed=2/frame_000004.exr"));
  // Errors are against the same reference bits, whether it was rendered or found.
  const auto curve = [this](const std::string& results) {
    return parse_csv(folder_.read("results/" + results + "/method=rl,seed=1/convergence.csv"))
        .back()
        .at("relmse");
  };
  EXPECT_EQ(curve("twice"), curve("twice.1"));
}

TEST_F(RunProgram, FilteredImagesAreMeasuredOnTheirOwn) {
  const Outcome outcome = run("soft", R"("sweep": [{"filter.kind": ["none", "atrous"]}], )");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string plain = "results/soft/filter.kind=none/";
  const std::string soft = "results/soft/filter.kind=atrous/";
  EXPECT_FALSE(std::filesystem::exists(folder_ / (plain + "convergence_filtered.csv")));
  const auto curve = parse_csv(folder_.read(soft + "convergence.csv"));
  const auto filtered = parse_csv(folder_.read(soft + "convergence_filtered.csv"));
  ASSERT_EQ(filtered.size(), 3U);
  EXPECT_FALSE(filtered[0].contains("relmse"));
  EXPECT_FALSE(curve[0].contains("filtered_relmse"));
  EXPECT_LT(std::stod(filtered[0].at("filtered_relmse")), std::stod(curve[0].at("relmse")));
  EXPECT_GT(std::stod(filtered[0].at("filter_ms")), 0);
  EXPECT_EQ(curve[2].at("relmse"), parse_csv(folder_.read(plain + "convergence.csv"))[2].at("relmse"));
  const auto summary = parse_csv(folder_.read("results/soft/summary.csv"));
  EXPECT_EQ(summary[0].at("filtered_relmse"), "");
  EXPECT_EQ(summary[1].at("filtered_relmse"), filtered[2].at("filtered_relmse"));
  EXPECT_FALSE(read_exr(folder_ / (plain + "frame_000004.exr")).channels.contains("filtered.R"));
  const experiments::ExrImage image = read_exr(folder_ / (soft + "frame_000004.exr"));
  EXPECT_TRUE(image.channels.contains("filtered.B"));
  EXPECT_NE(image.channels.at("filtered.R"), image.channels.at("R"));
  EXPECT_EQ(image.channels.at("R"), read_exr(folder_ / (plain + "frame_000004.exr")).channels.at("R"));
  EXPECT_TRUE(contains(outcome.out, "atrous, à-trous (biased)"));
  EXPECT_TRUE(contains(outcome.out, "Its time is filter_ms in summary.csv"));
}

TEST_F(RunProgram, FlipIsMeasuredWhereItIsAskedFor) {
  ASSERT_EQ(run("seen", R"("sweep": [{"flip": [false, true]}], "filter": {"kind": "atrous"}, )").exit_code,
            0);
  const auto without = parse_csv(folder_.read("results/seen/flip=false/convergence.csv"));
  const auto curve = parse_csv(folder_.read("results/seen/flip=true/convergence.csv"));
  const auto filtered = parse_csv(folder_.read("results/seen/flip=true/convergence_filtered.csv"));
  const auto summary = parse_csv(folder_.read("results/seen/summary.csv"));
  EXPECT_EQ(without[2].at("flip"), "");
  EXPECT_EQ(without[2].at("smape"), curve[2].at("smape"));
  EXPECT_LT(std::stod(curve[2].at("flip")), std::stod(curve[0].at("flip")));
  EXPECT_NE(filtered[2].at("filtered_flip"), curve[2].at("flip"));
  EXPECT_EQ(summary[1].at("flip"), curve[2].at("flip"));
  EXPECT_EQ(summary[1].at("filtered_flip"), filtered[2].at("filtered_flip"));
  // The same from the files, whose values are rounded to 32 bits.
  const std::string reference = json("results/seen/flip=true/manifest.json").at("reference").at("file");
  const Outcome outcome =
      run_qtrace({"compare", "results/seen/flip=true/frame_000004.exr", reference}, folder_.path());
  const std::size_t line = outcome.out.find("\nflip ");
  ASSERT_NE(line, std::string::npos) << outcome.out << outcome.err;
  EXPECT_NEAR(std::stod(outcome.out.substr(line + 6)), std::stod(curve[2].at("flip")), 1e-5);
}

TEST_F(RunProgram, FirefliesAndClampingAreFiguresOfARun) {
  const Outcome outcome = run(
      "sparks", R"("sampler": "uniform", "firefly_multiple": 2, "sweep": [{"clamp_radiance": [0, 0.25]}], )");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto summary = parse_csv(folder_.read("results/sparks/summary.csv"));
  const double fireflies = std::stod(summary[0].at("fireflies"));
  EXPECT_GT(fireflies, 0);
  EXPECT_NEAR(std::stod(summary[0].at("fireflies_per_million")), fireflies / 256 * 1e6, 1e-6);
  EXPECT_GT(std::stod(summary[0].at("firefly_energy_fraction")), 0);
  EXPECT_LE(std::stod(summary[0].at("firefly_energy_fraction")), 1);
  EXPECT_EQ(summary[0].at("clamped_samples"), "0");
  EXPECT_EQ(summary[0].at("clamp_bias"), "0");
  // Judged before clamping: the same ones.
  for (const char* column : {"fireflies", "brightest_firefly"}) {
    EXPECT_EQ(summary[1].at(column), summary[0].at(column)) << column;
  }
  EXPECT_NE(summary[1].at("clamped_samples"), "0");
  EXPECT_NEAR(std::stod(summary[1].at("bias")) - std::stod(summary[0].at("bias")),
              std::stod(summary[1].at("clamp_bias")), 1e-9);
  const auto curve = parse_csv(folder_.read("results/sparks/clamp_radiance=0.25/convergence.csv"));
  EXPECT_EQ(curve[2].at("clamp_bias"), summary[1].at("clamp_bias"));
  EXPECT_EQ(curve[2].at("clamped_samples"), summary[1].at("clamped_samples"));
  EXPECT_TRUE(contains(outcome.out, "clamped (biased): clamp_radiance 0.25")) << outcome.out;

  const Json list = json("results/sparks/clamp_radiance=0/manifest.json").at("brightest_fireflies");
  ASSERT_GT(list.size(), 0U);
  EXPECT_EQ(list[0].at("radiance").get<double>(), std::stod(summary[0].at("brightest_firefly")));
  for (const Json& firefly : list) EXPECT_GT(firefly.at("multiple").get<double>(), 2);
  const auto frames = parse_csv(folder_.read("results/sparks/clamp_radiance=0/frames.csv"));
  double sum = 0;
  for (const auto& frame : frames) sum += std::stod(frame.at("fireflies"));
  EXPECT_EQ(sum, fireflies);
}

TEST_F(RunProgram, ReferencesAreFoundAgainAndBrokenOnesRenderedAnew) {
  ASSERT_TRUE(contains(run("ref", "", {"--fresh"}).err, "reference of scene: 16 frames rendered"));
  std::string name;
  for (const std::string& file : tree(folder_ / "results/references")) {
    if (file.ends_with(".exr")) name = file;
  }
  const std::string file = "results/references/" + name;
  const std::string whole = folder_.read(file);
  const Outcome found = run("ref", "", {"--fresh"});
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_FALSE(contains(found.err, "rendered")) << found.err;
  folder_.write(file, whole.substr(0, whole.size() / 2));
  const Outcome outcome = run("ref", "", {"--fresh"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(contains(outcome.err, "warning: this reference cannot be used and is rendered anew: " + file));
  EXPECT_EQ(folder_.read(file), whole);
  // Shipped beside the config: nothing is rendered into the results.
  folder_.write("references/" + name, whole);
  std::filesystem::remove_all(folder_ / "results");
  EXPECT_EQ(run("ref", "", {"--fresh"}).exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "results/references"));
  EXPECT_EQ(json("results/ref/run/manifest.json").at("reference").at("origin"), "shipped");
}

TEST_F(RunProgram, CompareFindsAnImageEqualToItself) {
  ASSERT_EQ(run("cmp", "", {"--quiet"}).exit_code, 0);
  const std::string image = "results/cmp/run/frame_000004.exr";
  const Outcome same = run_qtrace({"compare", image, image}, folder_.path());
  EXPECT_EQ(same.exit_code, 0);
  EXPECT_TRUE(contains(same.out, "relmse              0 ")) << same.out;
  EXPECT_TRUE(contains(same.out, "0 of 64 pixels"));
  const Outcome other = run_qtrace({"compare", "results/cmp/run/frame_000001.exr", image}, folder_.path());
  EXPECT_EQ(other.exit_code, 0) << other.err;
  EXPECT_TRUE(contains(other.out, "\nrelmse              ")) << other.out;
  EXPECT_FALSE(contains(other.out, "relmse              0 "));
}

TEST_F(RunProgram, ASceneWithoutLightIsBlackAndNoError) {
  write_small_scene(folder_, "dark", Light::off);
  const Outcome outcome =
      run("dark", R"("sweep": [{"scene": ["dark.gltf"]}, {"sampler": ["bsdf", "rl"]}], )");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "warning: dark.gltf: the scene has no light: the image will be black"));
  for (const char* sampler : {"bsdf", "rl"}) {
    const std::string base = std::string("results/dark/scene=dark,sampler=") + sampler;
    const auto channels = read_exr(folder_ / (base + "/frame_000004.exr")).channels;
    ASSERT_TRUE(channels.contains("R") && channels.contains("variance.R"));
    for (const auto& [name, plane] : channels) {
      ASSERT_EQ(plane.size(), 64U) << name;
      for (const float value : plane) EXPECT_EQ(value, 0) << name;
    }
    EXPECT_EQ(parse_csv(folder_.read(base + "/convergence.csv")).back().at("relmse"), "0");
    EXPECT_TRUE(contains(json(base + "/manifest.json").at("warnings").dump(), "no light"));
  }
}

// A folder stands where the first run's reference should be kept.
TEST_F(RunProgram, AFailedRunDoesNotStopTheOthers) {
  constexpr const char* kSweep = R"("sweep": [{"max_bounces": [1, 2]}], )";
  const Outcome plan = run("fail", kSweep, {"--dry-run"});
  const std::string word = "reference ";
  const std::size_t place = plan.out.find(word);
  ASSERT_NE(place, std::string::npos) << plan.out;
  const std::string hash = plan.out.substr(place + word.size(), 32);
  std::filesystem::create_directories(folder_ / ("results/references/" + hash + ".exr/in_the_way"));

  const Outcome outcome = run("fail", kSweep);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_TRUE(contains(outcome.err, "run 1/2 max_bounces=1: failed: ")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "run 2/2 max_bounces=2: finished")) << outcome.err;
  const auto summary = parse_csv(folder_.read("results/fail/summary.csv"));
  ASSERT_EQ(summary.size(), 2U);
  EXPECT_EQ(summary[0].at("status"), "failed");
  EXPECT_NE(summary[0].at("reason"), "");
  EXPECT_EQ(summary[0].at("relmse"), "");
  EXPECT_EQ(summary[1].at("status"), "finished");
  EXPECT_EQ(json("results/fail/max_bounces=1/manifest.json").at("reason"), summary[0].at("reason"));
  EXPECT_EQ(json("results/fail/manifest.json").at("status"), "failed");
  EXPECT_TRUE(contains(outcome.out, "Failed runs:"));
}

TEST_F(RunProgram, WhatTheDeviceCannotHoldIsRefusedBeforeAnythingStarts) {
  const Outcome outcome = run("large", R"("sweep": [{"table": {
      "small": {"sampler": "rl", "rl": {"sites_per_object": 4}},
      "too large": {"sampler": "rl", "rl": {"sites_per_object": 100000, "bins_theta": 64, "bins_phi": 64}}}}], )");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_TRUE(contains(outcome.err, "large.json: run 'table=too-large': the buffer of Q targets"))
      << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "results"));
}

}  // namespace
}  // namespace qtrace::tests
