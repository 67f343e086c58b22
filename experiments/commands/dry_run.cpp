#include "experiments/commands/dry_run.h"

#include "engine/core/check.h"
#include "experiments/study/calibration.h"
#include "experiments/study/disk_space.h"
#include "experiments/study/plan.h"
#include "experiments/reference/reference_store.h"
#include "experiments/run/run_store.h"
#include "experiments/files/text_table.h"

#include <algorithm>
#include <map>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

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
  const Calibration calibration(experiment, left, context, scenes, progress);
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
      const Speed speed = measure_speed(context, scene, spec.settings);
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
