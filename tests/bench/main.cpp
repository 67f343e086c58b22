// Speed: ./dev bench.
#include "engine/core/check.h"
#include "tests/bench/ray_bench.h"

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
      .scenes = {QTRACE_SOURCE_DIR "/configs/scenes/simple.glb", "room:200000", "room:5000000"},
      .rounds = 9,
      .size = 512,
      .threads = std::max(1U, std::thread::hardware_concurrency()),
      .out = "results/bench"};
  std::vector<std::string> variants;
  std::string device;
};

void add_options(CLI::App& app, Options& options) {
  constexpr int kMostRounds = 1000;
  constexpr int kMostSize = 1024;
  app.add_option("--scenes", options.rays.scenes, "glTF files, or room:TRIANGLES")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--variant", options.variants,
                 "NAME:KEY=VALUE,...: the ray query once more, compiled with these defines; may be repeated");
  app.add_option("--rounds", options.rays.rounds, "interleaved rounds; figures are their medians")
      ->check(CLI::Range(1, kMostRounds))
      ->capture_default_str();
  app.add_option("--size", options.rays.size, "pixels along a side of the image that rays belong to")
      ->check(CLI::Range(1, kMostSize))
      ->capture_default_str();
  app.add_option("--threads", options.rays.threads, "of Embree; llvmpipe uses one per core")
      ->check(CLI::Range(1, kMostRounds))
      ->capture_default_str();
  app.add_option("--out", options.rays.out, "folder of the CSV files")->capture_default_str();
  app.add_option("--device", options.device, "index or part of a name, see `qtrace devices`");
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app("Speed of ray queries beside Embree 3", "qtrace_bench");
  add_options(app, options);
  CLI11_PARSE(app, argc, argv);
  options.rays.variants.push_back({"qtrace", {}});
  for (const std::string& text : options.variants) options.rays.variants.push_back(read_variant(text));
  const gpu::Context context(options.device);
  fmt::print("{}, Embree 3 on {} threads\n", context.device().renderer, options.rays.threads);
  std::filesystem::create_directories(options.rays.out);
  bench_rays(context, options.rays);
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
