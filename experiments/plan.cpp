#include "experiments/plan.h"

#include "engine/core/check.h"

#include <fnmatch.h>

#include <algorithm>
#include <map>

namespace qtrace::experiments {
namespace {

constexpr int kRounds = 4;  // the first at an eighth of the frames

int end_of_round(const RunConfig& config, int round) {
  const std::vector<int> snapshots = config.snapshots.resolve(config.frames);
  return *std::ranges::lower_bound(snapshots, std::max(1, config.frames >> (kRounds - round)));
}

}  // namespace

std::vector<Turn> execution_order(const Experiment& experiment) {
  std::map<std::string, int> runs_of_cell;
  std::vector<std::pair<int, std::size_t>> places;  // (repetition, place)
  for (std::size_t i = 0; i < experiment.runs.size(); ++i) {
    places.emplace_back(runs_of_cell[experiment.runs[i].cell]++, i);
  }
  std::ranges::sort(places);
  std::vector<Turn> turns;
  for (const auto& [repetition, place] : places) {
    turns.push_back({place, static_cast<int>(turns.size()) + 1, repetition});
  }
  return turns;
}

std::vector<Turn> chosen_turns(const Experiment& experiment, const RunChoices& choices) {
  std::vector<Turn> turns;
  std::size_t fitting = 0;
  for (const Turn& turn : execution_order(experiment)) {
    const std::string& id = experiment.runs[turn.place].id;
    if (!choices.only.empty() && ::fnmatch(choices.only.c_str(), id.c_str(), 0) != 0) continue;
    ++fitting;
    // Dealt out one by one, so that every shard has its share of every cell's repetitions.
    if (static_cast<std::size_t>(turn.order - 1) % choices.shard.count == choices.shard.index - 1)
      turns.push_back(turn);
  }
  check(fitting > 0, "{}: no run fits --only '{}'; --list shows their names, such as '{}'",
        experiment.file.string(), choices.only, experiment.runs.front().id);
  return turns;
}

std::vector<Step> steps_of(const Experiment& experiment, const std::vector<Turn>& turns, bool in_rounds) {
  std::vector<Step> steps;
  for (int round = in_rounds ? 1 : kRounds; round <= kRounds; ++round) {
    for (const Turn& turn : turns) {
      const bool grows = in_rounds && turn.repetition == 0;
      if (!grows && round < kRounds) continue;
      const int until = end_of_round(experiment.runs[turn.place].config, round);
      const bool is_new = round == 1 || end_of_round(experiment.runs[turn.place].config, round - 1) < until;
      if (is_new || !grows) steps.push_back({turn, until});
    }
  }
  return steps;
}

std::vector<ReferenceSpec> needed_references(const Experiment& experiment, const std::vector<Turn>& turns,
                                             SceneStore& scenes) {
  std::vector<ReferenceSpec> specs;
  for (const Turn& turn : turns) {
    const Run& run = experiment.runs[turn.place];
    ReferenceSpec spec = reference_spec(run.config, scenes.load(experiment.reference_file(run)).hash);
    const auto same = std::ranges::find(specs, spec.hash, &ReferenceSpec::hash);
    if (same == specs.end()) {
      specs.push_back(std::move(spec));
    } else {
      same->wish = same->wish.joined(spec.wish);
    }
  }
  return specs;
}

}  // namespace qtrace::experiments
