#include "experiments/study/plan.h"

#include "engine/core/check.h"

#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace qtrace::experiments {
namespace {

// `halvings` before the last round.
int end_of_round(const RunConfig& config, int halvings) {
  const std::vector<int> snapshots = config.snapshots.resolve(config.frames);
  return *std::ranges::lower_bound(snapshots, std::max(1, config.frames >> halvings));
}

}  // namespace

std::vector<Turn> execution_order(const Experiment& experiment) {
  std::map<std::string, int> runs_of_configuration;
  std::vector<std::pair<int, std::size_t>> places;  // (repetition, place)
  for (std::size_t i = 0; i < experiment.runs.size(); ++i) {
    places.emplace_back(runs_of_configuration[experiment.runs[i].configuration]++, i);
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
    // Dealt out one by one, so that every shard has its share of every configuration's repetitions.
    if (static_cast<std::size_t>(turn.order - 1) % choices.shard.count == choices.shard.index - 1)
      turns.push_back(turn);
  }
  check(fitting > 0, "{}: no run fits --only '{}'; --list shows their names, such as '{}'",
        experiment.file.string(), choices.only, experiment.runs.front().id);
  return turns;
}

std::vector<Step> steps_of(const Experiment& experiment, const std::vector<Turn>& turns, int rounds) {
  std::vector<Step> steps;
  for (int halvings = rounds - 1; halvings >= 0; --halvings) {
    for (const Turn& turn : turns) {
      if (turn.repetition > 0 && halvings > 0) continue;
      const RunConfig& config = experiment.runs[turn.place].config;
      const int until = end_of_round(config, halvings);
      const bool is_first = halvings == rounds - 1 || turn.repetition > 0;
      if (is_first || end_of_round(config, halvings + 1) < until) steps.push_back({turn, until});
    }
  }
  return steps;
}

int rounds_for(double seconds, double budget) {
  int rounds = 1;
  while (rounds < kMostRounds && std::ldexp(seconds, 1 - rounds) > kFirstRound * budget) ++rounds;
  return rounds;
}

}  // namespace qtrace::experiments
