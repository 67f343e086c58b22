#include "experiments/dry_run.h"

#include "engine/core/check.h"
#include "engine/tracer/tracer.h"
#include "experiments/disk_space.h"
#include "experiments/plan.h"
#include "experiments/reference_store.h"
#include "experiments/run_store.h"
#include "experiments/text_table.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostMeasured = 32;    // cells; the others are taken for their mean
constexpr double kLongestMeasurement = 0.5;  // seconds of frames per cell
constexpr int kMostFrames = 16;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Speed {
  double setup_s = 0;
  double frame_s = 0;
};

// A tracer's first frames, the very first left out.
Speed measure(const gpu::Context& context, const Scene& scene, const RenderSettings& settings) {
  Speed speed;
  auto start = Clock::now();
  Tracer tracer(context, scene, settings);
  tracer.render_frame();
  context.finish();
  speed.setup_s = seconds_since(start);
  start = Clock::now();
  int frames = 0;
  do {
    tracer.render_frame();
    context.finish();
    ++frames;
  } while (frames < kMostFrames && seconds_since(start) < kLongestMeasurement);
  speed.frame_s = seconds_since(start) / frames;
  return speed;
}

// What is there of a run.
struct State {
  std::string text = "to do";
  int frames = 0;  // that need not be rendered again
};

State state_of(const Experiment& experiment, const Run& run, const gpu::Context& context, SceneStore& scenes,
               const fs::path& folder) {
  const RunStore store(folder / run.id,
                       run_identity(run.config, scenes.load(experiment.scene_file(run)).hash,
                                    scenes.load(experiment.reference_file(run)).hash, context.device()));
  const auto ignore = [](const Error&) {};
  if (const auto record = store.read_record(run, ignore)) {
    return record->status == "finished" ? State{"finished", run.config.frames}
                                        : State{"failed, to be tried again", 0};
  }
  const auto checkpoint = store.read_checkpoint(ignore);
  if (!checkpoint) return {};
  const int frames = static_cast<int>(checkpoint->state.frames);
  return {fmt::format("{} frames done", frames), frames};
}

// One cell's speed for all of its runs; at most kMostMeasured cells, evenly spread.
class Calibration {
 public:
  Calibration(const Experiment& experiment, const std::vector<Turn>& turns) {
    std::vector<std::string> cells;
    for (const Turn& turn : turns) {
      const std::string& cell = experiment.runs[turn.place].cell;
      if (std::ranges::find(cells, cell) == cells.end()) cells.push_back(cell);
      if (cells.size() > kMostCells) break;
    }
    count_ = cells.size();
    const std::size_t step = (cells.size() + kMostMeasured - 1) / kMostMeasured;
    for (std::size_t i = 0; i < cells.size(); i += std::max<std::size_t>(step, 1))
      wanted_[cells[i]] = std::nullopt;
  }

  void measure_cells(const Experiment& experiment, const std::vector<Turn>& turns,
                     const gpu::Context& context, SceneStore& scenes, Progress& progress) {
    for (const Turn& turn : turns) {
      const Run& run = experiment.runs[turn.place];
      const auto cell = wanted_.find(run.cell);
      if (cell == wanted_.end() || cell->second) continue;
      progress.note(fmt::format("measuring {}", run.cell));
      cell->second = measure(context, scenes.load(experiment.scene_file(run)).scene, run.config.render);
    }
  }

  // Where a cell was not measured: by the mean time per pixel of those that were.
  double seconds(const Run& run, int frames_left) const {
    const auto own = wanted_.find(run.cell);
    const Speed speed = own != wanted_.end() && own->second ? *own->second : mean();
    return frames_left == 0 ? 0 : speed.setup_s + speed.frame_s * frames_left;
  }

  std::string text() const {
    return count_ <= wanted_.size() ? fmt::format("measured on all {} cells", count_)
                                    : fmt::format("measured on {} of its cells", wanted_.size());
  }

 private:
  static constexpr std::size_t kMostCells = 100000;

  Speed mean() const {
    Speed sum;
    double count = 0;
    for (const auto& [cell, speed] : wanted_) {
      if (!speed) continue;
      sum.setup_s += speed->setup_s, sum.frame_s += speed->frame_s, ++count;
    }
    return count == 0 ? sum : Speed{sum.setup_s / count, sum.frame_s / count};
  }

  std::map<std::string, std::optional<Speed>> wanted_;
  std::size_t count_ = 0;
};

}  // namespace

std::string dry_run(const Experiment& experiment, const gpu::Context& context, SceneStore& scenes,
                    const RunChoices& choices, Progress& progress) {
  const fs::path folder = choices.root / experiment.name;
  const std::vector<Turn> turns = chosen_turns(experiment, choices);
  std::vector<Turn> left;
  std::map<std::size_t, State> states;
  for (const Turn& turn : turns) {
    const State state = state_of(experiment, experiment.runs[turn.place], context, scenes, folder);
    states[turn.place] = state;
    if (state.frames < experiment.runs[turn.place].config.frames) left.push_back(turn);
  }
  Calibration calibration(experiment, left);
  calibration.measure_cells(experiment, left, context, scenes, progress);
  double seconds = 0;
  std::vector<std::vector<std::string>> rows;
  for (const Turn& turn : turns) {
    const Run& run = experiment.runs[turn.place];
    const RenderSettings& render = run.config.render;
    const Scene& scene = scenes.load(experiment.scene_file(run)).scene;
    const State& state = states[turn.place];
    const double own = calibration.seconds(run, run.config.frames - state.frames);
    seconds += own;
    rows.push_back({run.id, fmt::format("{} ({} triangles)", scene.name, scene.triangles.size()),
                    fmt::format("{}x{}", render.width, render.height), std::to_string(run.config.frames),
                    std::to_string(render.max_bounces), std::string(enum_name(render.sampler)),
                    std::string(enum_name(render.nee)), std::to_string(render.seed), state.text,
                    duration_text(own)});
  }
  std::string text = fmt::format("{}: {} runs, {} to do\n", experiment.name, turns.size(), left.size());
  text += plain_table(
      {"run", "scene", "size", "frames", "bounces", "sampler", "nee", "seed", "state", "left"}, rows);
  std::vector<ReferenceSpec> missing;
  for (const ReferenceSpec& spec : needed_references(experiment, left, scenes)) {
    const ReferenceOutlook outlook = ReferenceStore::outlook(spec, choices.root, experiment.folder());
    text += fmt::format("reference {}: {}, {}", spec.hash, spec.wish.text(), outlook.text());
    if (!outlook.enough) {
      missing.push_back(spec);
      const auto run = std::ranges::find_if(left, [&](const Turn& turn) {
        const Run& r = experiment.runs[turn.place];
        return reference_spec(r.config, scenes.load(experiment.reference_file(r)).hash).hash == spec.hash;
      });
      const Scene& scene = scenes.load(experiment.reference_file(experiment.runs[run->place])).scene;
      const Speed speed = measure(context, scene, spec.settings);
      const double own = speed.setup_s + speed.frame_s * std::max(0, spec.wish.frames - outlook.frames);
      seconds += own;
      text += fmt::format(", {}{}", duration_text(own),
                          spec.wish.relative_error > 0 ? " or, for its noise, more" : "");
    }
    text += '\n';
  }
  text += fmt::format("time: about {}, {}, besides images and errors\n", duration_text(seconds),
                      calibration.text());
  text += fmt::format("disk: at most {} of {} free\n",
                      bytes_text(needed_bytes(experiment, left, missing, scenes)),
                      bytes_text(free_bytes(folder)));
  return text;
}

}  // namespace qtrace::experiments
