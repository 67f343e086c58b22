#include "tests/bench/frame_bench.h"

#include "engine/core/check.h"
#include "experiments/files/atomic_file.h"
#include "experiments/files/csv.h"
#include "experiments/runtime/scene_store.h"
#include "experiments/files/text_table.h"
#include "tests/bench/rounds.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <set>

namespace qtrace::bench {
namespace {

using experiments::Run;

// A configuration with what renders it.
struct Configuration {
  const Run* run;
  std::unique_ptr<Tracer> tracer;
};

struct Row {
  std::string scene;
  std::string method;
  int size;
  std::size_t rounds;
  std::uint64_t rays;  // of the last frame
  Spread wall_ms;
  Spread cpu_ms;
  Spread host_ms;
  Spread over_plain;      // by the clock
  Spread cpu_over_plain;  // by processor time
};

const std::vector<experiments::Column<Row>>& columns() {
  static const std::vector<experiments::Column<Row>> all{
      {"scene", [](const Row& r) { return r.scene; }},
      {"method", [](const Row& r) { return r.method; }},
      {"size", [](const Row& r) { return std::int64_t{r.size}; }},
      {"rounds", [](const Row& r) { return std::uint64_t{r.rounds}; }},
      {"rays", [](const Row& r) { return r.rays; }},
      {"wall_ms", [](const Row& r) { return r.wall_ms.median; }},
      {"wall_ms_low", [](const Row& r) { return r.wall_ms.low; }},
      {"wall_ms_high", [](const Row& r) { return r.wall_ms.high; }},
      {"cpu_ms", [](const Row& r) { return r.cpu_ms.median; }},
      {"host_ms", [](const Row& r) { return r.host_ms.median; }},
      {"host_ms_low", [](const Row& r) { return r.host_ms.low; }},
      {"host_ms_high", [](const Row& r) { return r.host_ms.high; }},
      {"over_plain", [](const Row& r) { return r.over_plain.median; }},
      {"over_plain_low", [](const Row& r) { return r.over_plain.low; }},
      {"over_plain_high", [](const Row& r) { return r.over_plain.high; }},
      {"cpu_over_plain", [](const Row& r) { return r.cpu_over_plain.median; }},
  };
  return all;
}

void print(const std::vector<Row>& rows) {
  std::vector<std::vector<std::string>> cells;
  for (const Row& r : rows) {
    cells.push_back({r.scene, r.method, text_of(r.wall_ms), text_of(r.over_plain),
                     fmt::format("{:.3g}", r.cpu_over_plain.median), text_of(r.host_ms),
                     fmt::format("{:.3g}", 1e-3 * static_cast<double>(r.rays) / r.wall_ms.median)});
  }
  fmt::print("\n{}\n", experiments::markdown_table({"scene", "method", "ms/frame", "over BSDF", "by CPU time",
                                                    "of it on the host, ms", "Mrays/s"},
                                                   cells, 2));
  std::fflush(stdout);
}

// The configurations of one scene in one interleaving: ratios are taken within a scene.
void bench_scene_configurations(const gpu::Context& context, const std::vector<Configuration>& configurations, int rounds,
                       std::vector<Row>& rows, std::vector<RoundRow>& round_rows) {
  std::vector<Contender> contenders;
  const Contender* plain = nullptr;
  for (const Configuration& configuration : configurations) {
    contenders.push_back({configuration.run->labels.back(), [&] { return timed_frame(context, *configuration.tracer); }});
  }
  run_rounds(contenders, rounds);
  for (std::size_t i = 0; i < configurations.size(); ++i) {
    if (is_plain(configurations[i].run->config.render)) plain = &contenders[i];
  }
  check(plain != nullptr, "{} has no configuration of plain BSDF sampling to compare with", configurations.front().run->configuration);
  for (std::size_t i = 0; i < configurations.size(); ++i) {
    const Run& run = *configurations[i].run;
    const Contender& c = contenders[i];
    rows.push_back({run.labels.front(), c.name, run.config.render.width, c.wall_s.size(),
                    configurations[i].tracer->last_frame_counters().rays, kMilliseconds * spread_of(c.wall_s),
                    kMilliseconds * spread_of(c.cpu_s), kMilliseconds * spread_of(c.host_s),
                    ratio_of(c.wall_s, plain->wall_s), ratio_of(c.cpu_s, plain->cpu_s)});
    append_rounds(round_rows, {run.labels.front(), c.name}, c);
  }
}

}  // namespace

experiments::Experiment paper_table(int size) {
  experiments::Experiment experiment =
      experiments::load_experiment(QTRACE_SOURCE_DIR "/configs/paper_table.json",
                                   {fmt::format("width={}", size), fmt::format("height={}", size)});
  std::set<std::string> seen;
  std::erase_if(experiment.runs, [&](const Run& run) {
    return run.config.render.random != RandomNumbers::independent || !seen.insert(run.configuration).second;
  });
  for (Run& run : experiment.runs) run.labels.resize(2);  // of scene and method
  return experiment;
}

Duration timed_frame(const gpu::Context& context, Tracer& tracer) {
  return timed([&] { tracer.render_frame(); }, [&] { context.finish(); });
}

bool is_plain(const RenderSettings& settings) {
  return settings.sampler == Sampler::bsdf && settings.nee == Nee::none;
}

void bench_frames(const gpu::Context& context, const FrameBenchOptions& options) {
  const experiments::Experiment experiment = paper_table(options.size);
  experiments::SceneStore scenes;
  std::vector<Row> rows;
  std::vector<RoundRow> rounds;
  for (std::size_t i = 0; i < experiment.runs.size();) {
    const std::filesystem::path file = experiment.scene_file(experiment.runs[i]);
    std::vector<Configuration> configurations;
    for (; i < experiment.runs.size() && experiment.scene_file(experiment.runs[i]) == file; ++i) {
      const Run& run = experiment.runs[i];
      configurations.push_back({&run, std::make_unique<Tracer>(context, scenes.load(file).scene, run.config.render)});
    }
    bench_scene_configurations(context, configurations, options.rounds, rows, rounds);
  }
  print(rows);
  experiments::write_file(options.out / "frames.csv", experiments::csv_text(columns(), rows));
  experiments::write_file(options.out / "frame_rounds.csv", rounds_csv({"scene", "method"}, rounds));
}

}  // namespace qtrace::bench
