#include "tests/bench/step_bench.h"

#include "engine/core/check.h"
#include "experiments/files/atomic_file.h"
#include "experiments/files/csv.h"
#include "experiments/runtime/scene_store.h"
#include "experiments/files/text_table.h"
#include "tests/bench/rounds.h"
#include "tests/bench/staged_frame.h"

#include <cstdio>

namespace qtrace::bench {
namespace {

struct Row {
  std::string scene;
  std::string method;
  std::string step;
  std::string measured;
  int size;
  Spread wall_ms;
  Spread share;      // of the whole frame, by the clock
  Spread cpu_share;  // by processor time
};

const std::vector<experiments::Column<Row>>& columns() {
  static const std::vector<experiments::Column<Row>> all{
      {"scene", [](const Row& r) { return r.scene; }},
      {"method", [](const Row& r) { return r.method; }},
      {"step", [](const Row& r) { return r.step; }},
      {"measured", [](const Row& r) { return r.measured; }},
      {"size", [](const Row& r) { return std::int64_t{r.size}; }},
      {"wall_ms", [](const Row& r) { return r.wall_ms.median; }},
      {"wall_ms_low", [](const Row& r) { return r.wall_ms.low; }},
      {"wall_ms_high", [](const Row& r) { return r.wall_ms.high; }},
      {"share", [](const Row& r) { return r.share.median; }},
      {"share_low", [](const Row& r) { return r.share.low; }},
      {"share_high", [](const Row& r) { return r.share.high; }},
      {"cpu_share", [](const Row& r) { return r.cpu_share.median; }},
      {"cpu_share_low", [](const Row& r) { return r.cpu_share.low; }},
      {"cpu_share_high", [](const Row& r) { return r.cpu_share.high; }},
  };
  return all;
}

enum Stage : std::size_t { whole, trace, cell_twice, direction_twice, no_targets, accumulate, learn };

std::vector<Contender> contenders_of(const gpu::Context& context, StagedFrame& frame) {
  const auto finish = [&context] { context.finish(); };
  const auto tracing = [&frame, finish](TraceForm form) {
    return [&frame, finish, form] {
      const Duration time = timed([&] { frame.trace(form); }, finish);
      frame.forget();
      finish();  // not within what is timed next
      return time;
    };
  };
  return {
      {"whole frame",
       [&frame, finish] {
         frame.next_frame();
         return timed(
             [&] {
               frame.trace(TraceForm::plain);
               frame.accumulate();
               frame.learn();
             },
             finish);
       }},
      {"tracing", tracing(TraceForm::plain)},
      {"tracing, cells twice", tracing(TraceForm::cell_twice)},
      {"tracing, directions twice", tracing(TraceForm::direction_twice)},
      {"tracing, no targets", tracing(TraceForm::no_targets)},
      {"accumulation",
       [&frame, finish] {
         frame.trace(TraceForm::plain);
         frame.forget();
         finish();
         return timed([&] { frame.accumulate(); }, finish);
       }},
      {"learning",
       [&frame, finish] {
         frame.trace(TraceForm::plain);
         finish();
         return timed([&] { frame.learn(); }, finish);
       }},
  };
}

// A step as a sum of stages, each with its sign.
struct Step {
  std::string name;
  std::string measured;
  std::vector<std::pair<double, Stage>> parts;
};

const std::vector<Step>& steps() {
  static const std::vector<Step> all{
      {"cell look-up", "done twice", {{1, cell_twice}, {-1, trace}}},
      {"direction and density", "done twice", {{1, direction_twice}, {-1, trace}}},
      {"gathering of targets", "left out", {{1, trace}, {-1, no_targets}}},
      {"learning", "pass", {{1, learn}}},
      {"accumulation", "pass", {{1, accumulate}}},
      {"rest of tracing",
       "what remains",
       {{2, trace}, {-1, cell_twice}, {-1, direction_twice}, {1, no_targets}}},
      {"whole frame", "frame", {{1, whole}}},
  };
  return all;
}

std::vector<double> step_times(const Step& step, const std::vector<Contender>& contenders,
                               std::vector<double> Contender::*times) {
  std::vector<double> sums(((contenders[whole]).*times).size());
  for (const auto& [sign, stage] : step.parts) {
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += sign * (contenders[stage].*times)[i];
  }
  return sums;
}

void print(const std::vector<Row>& rows) {
  std::vector<std::vector<std::string>> cells;
  for (const Row& r : rows) {
    cells.push_back({r.scene, r.method, r.step, r.measured, text_of(r.wall_ms), text_of(100 * r.share),
                     text_of(100 * r.cpu_share)});
  }
  fmt::print("\n{}\n", experiments::markdown_table(
                           {"scene", "method", "step", "measured as", "ms", "% of the frame", "by CPU time"},
                           cells, 4));
  std::fflush(stdout);
}

}  // namespace

void bench_steps(const gpu::Context& context, const FrameBenchOptions& options) {
  const experiments::Experiment experiment = paper_table(options.size);
  experiments::SceneStore scenes;
  std::vector<Row> rows;
  std::vector<RoundRow> rounds;
  for (const experiments::Run& run : experiment.runs) {
    if (run.config.render.sampler != Sampler::rl) continue;
    const Scene& scene = scenes.load(experiment.scene_file(run)).scene;
    StagedFrame frame(context, scene, run.config.render);
    check_same_image(context, scene, run.config.render, frame);
    std::vector<Contender> contenders = contenders_of(context, frame);
    run_rounds(contenders, options.rounds);
    const std::string& method = run.labels.back();
    for (const Step& step : steps()) {
      const std::vector<double> wall = step_times(step, contenders, &Contender::wall_s);
      rows.push_back({run.labels.front(), method, step.name, step.measured, options.size,
                      kMilliseconds * spread_of(wall), ratio_of(wall, contenders[whole].wall_s),
                      ratio_of(step_times(step, contenders, &Contender::cpu_s), contenders[whole].cpu_s)});
    }
    for (const Contender& c : contenders) append_rounds(rounds, {run.labels.front(), method, c.name}, c);
  }
  print(rows);
  experiments::write_file(options.out / "steps.csv", experiments::csv_text(columns(), rows));
  experiments::write_file(options.out / "step_rounds.csv", rounds_csv({"scene", "method", "stage"}, rounds));
}

}  // namespace qtrace::bench
