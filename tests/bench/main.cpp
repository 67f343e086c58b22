// Speed: ./dev bench.
#include "engine/core/check.h"
#include "experiments/files/atomic_file.h"
#include "experiments/runtime/driver_store.h"
#include "experiments/runtime/manifest.h"
#include "tests/bench/design_bench.h"
#include "tests/bench/embree.h"
#include "tests/bench/feature_bench.h"
#include "tests/bench/frame_bench.h"
#include "tests/bench/growth_bench.h"
#include "tests/bench/limit_bench.h"
#include "tests/bench/ray_bench.h"
#include "tests/bench/scenes.h"
#include "tests/bench/step_bench.h"
#include "tests/bench/texel_bench.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <thread>

namespace qtrace::bench {
namespace {

// "NAME:KEY=VALUE,KEY=VALUE"; a name alone has no defines, a key alone is 1.
Variant read_variant(const std::string& text) {
  const std::size_t colon = text.find(':');
  Variant variant{text.substr(0, colon), {}};
  check(!variant.name.empty(), "--variant '{}': NAME:KEY=VALUE,... starts with a name", text);
  if (colon == std::string::npos) return variant;
  for (const std::string& define : CLI::detail::split(text.substr(colon + 1), ',')) {
    const std::size_t equals = define.find('=');
    check(equals != 0 && !define.empty(), "--variant '{}': a define without a name", text);
    variant.defines[define.substr(0, equals)] = equals == std::string::npos ? "1" : define.substr(equals + 1);
  }
  return variant;
}

struct Options {
  RayBenchOptions rays{
      .scenes = {QTRACE_SOURCE_DIR "/configs/scenes/simple.glb", "room:200000", "room:5000000"}};
  std::vector<std::string> variants;
  std::string only;
  std::string device;
  bool quick = false;
};

// What a full run and a quick one measure, where options do not say otherwise.
struct Effort {
  int ray_rounds, ray_size;
  int frame_rounds, frame_size;
  int growth_rounds, growth_size;
  double growth_share;  // of the values of each axis, from the smallest
};
constexpr Effort kFull{11, 512, 7, 512, 7, 256, 1};
constexpr Effort kQuick{5, 256, 7, 128, 5, 96, 0.6};

void add_options(CLI::App& app, Options& options) {
  constexpr int kMost = 1024;
  constexpr int kMostSize = 2040;  // its rays are within 65,535 work groups
  constexpr int kTile = 8;
  app.add_flag("--quick", options.quick, "a minute instead of ten, with wider spreads");
  app.add_option("--only", options.only, "one part of it")
      ->check(CLI::IsMember({"rays", "limits", "frames", "steps", "designs", "growth"}));
  app.add_option("--scenes", options.rays.scenes, "of the rays: glTF files, or room:TRIANGLES")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--variant", options.variants,
                 "NAME:KEY=VALUE,...: the ray query once more, compiled with these defines; may be repeated");
  app.add_option("--rounds", options.rays.rounds, "interleaved rounds; figures are their medians")
      ->check(CLI::Range(1, kMost));
  app.add_option("--size", options.rays.size, "pixels along a side of all images")
      ->check(CLI::Range(kTile, kMostSize));
  app.add_option("--threads", options.rays.threads, "of Embree; llvmpipe uses one per core")
      ->check(CLI::Range(1, kMost))
      ->default_val(std::max(1U, std::thread::hardware_concurrency()));
  app.add_option("--out", options.rays.out, "folder of the CSV files")->default_val("results/bench");
  app.add_option("--device", options.device, "index or part of a name, see `qtrace devices`");
}

// What the figures were measured on.
void write_manifest(const std::filesystem::path& out, const gpu::DeviceInfo& device, unsigned threads) {
  const experiments::Json manifest{{"program", experiments::program_json()},
                                   {"device", experiments::device_json(device)},
                                   {"embree", RTC_VERSION_STRING},
                                   {"embree_threads", threads}};
  experiments::write_file(out / "manifest.json", manifest.dump(2) + "\n");
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app("What takes time, and ray queries beside Embree's", "qtrace_bench");
  add_options(app, options);
  CLI11_PARSE(app, argc, argv);
  const Effort& effort = options.quick ? kQuick : kFull;
  const auto chosen = [](int wanted, int otherwise) { return wanted > 0 ? wanted : otherwise; };
  const auto wants = [&](std::string_view part) { return options.only.empty() || options.only == part; };
  const int rounds = options.rays.rounds;
  const int size = options.rays.size;
  options.rays.variants = {{"qtrace", {}}, {"threaded", {{"BVH", "1"}}}};
  for (const std::string& text : options.variants) options.rays.variants.push_back(read_variant(text));
  for (const std::string& scene : options.rays.scenes) check_scene(scene);
  options.rays.rounds = chosen(rounds, effort.ray_rounds);
  options.rays.size = chosen(size, effort.ray_size);
  const std::filesystem::path& out = options.rays.out;
  gpu::Context context(options.device);
  experiments::Progress progress(experiments::Progress::Mode::lines);
  experiments::choose_driver(context, progress);
  fmt::print("{}, Embree {} on {} threads; each figure is a median [and quartiles] over rounds\n",
             context.device().renderer, RTC_VERSION_STRING, options.rays.threads);
  std::filesystem::create_directories(out);
  write_manifest(out, context.device(), options.rays.threads);
  if (wants("rays")) bench_rays(context, options.rays);
  if (wants("limits")) bench_limits(context, options.rays);
  if (wants("frames")) {
    bench_frames(context, {chosen(rounds, effort.frame_rounds), chosen(size, effort.frame_size), out});
  }
  if (wants("steps")) {
    bench_steps(context, {chosen(rounds, effort.frame_rounds), chosen(size, effort.frame_size), out});
  }
  if (wants("designs")) {
    bench_designs(context, {chosen(rounds, effort.frame_rounds), chosen(size, effort.frame_size), out});
    bench_features(context, {chosen(rounds, effort.frame_rounds), chosen(size, effort.frame_size), out});
    bench_texels(context, {chosen(rounds, effort.frame_rounds), chosen(size, effort.frame_size), out});
  }
  if (wants("growth")) {
    bench_growth(context, {chosen(rounds, effort.growth_rounds), chosen(size, effort.growth_size),
                           effort.growth_share, out});
  }
  return 0;
}

}  // namespace
}  // namespace qtrace::bench

int main(int argc, char** argv) {
  try {
    return qtrace::bench::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "qtrace_bench: {}\n", error.what());
    return 1;
  }
}
