#include "experiments/commands/dry_run.h"

#include "engine/core/check.h"
#include "experiments/files/text_table.h"
#include "experiments/reference/reference_store.h"
#include "experiments/run/run_store.h"
#include "experiments/study/calibration.h"
#include "experiments/study/disk_space.h"
#include "experiments/study/experiment_inputs.h"
#include "experiments/study/plan.h"

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

State state_of(const Run& run, const RunInputs& inputs, const fs::path& folder) {
  const RunStore store(folder / run.id, inputs.identity);
  const auto ignore = [](const Error&) {};
  if (const auto record = store.read_record(run, ignore)) {
    return record->status == RunStatus::finished ? State{"finished", run.config.frames}
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
  const ExperimentInputs inputs(experiment, scenes, context.device());
  std::vector<Turn> left;
  std::map<std::size_t, State> states;
  for (const Turn& turn : turns) {
    const State state = state_of(experiment.runs[turn.place], inputs.of(turn), folder);
    states[turn.place] = state;
    if (state.frames < experiment.runs[turn.place].config.frames) left.push_back(turn);
  }
  const Calibration calibration(experiment, left, context, inputs, progress);
  double seconds = 0;
  std::vector<std::vector<std::string>> rows;
  for (const Turn& turn : turns) {
    const Run& run = experiment.runs[turn.place];
    const RenderSettings& render = run.config.render;
    const Scene& scene = inputs.of(turn).scene->scene;
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
  for (const ReferenceSpec& spec : inputs.references(left)) {
    const ReferenceOutlook outlook = ReferenceStore::outlook(spec, choices.root, experiment.folder());
    text += fmt::format("reference {}: {}, {}", spec.hash, spec.wish.text(), outlook.text());
    if (!outlook.enough) {
      missing.push_back(spec);
      const auto turn =
          std::ranges::find_if(left, [&](const Turn& t) { return inputs.of(t).reference_hash == spec.hash; });
      const Scene& scene = inputs.of(*turn).shown->scene;
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
                      bytes_text(needed_bytes(experiment, left, missing, inputs)),
                      bytes_text(free_bytes(folder)));
  return text;
}

}  // namespace qtrace::experiments
