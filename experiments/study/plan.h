// Which runs are done, in which order, and what that takes.
#pragma once

#include "experiments/config/experiment_config.h"
#include "experiments/study/run_choices.h"

#include <cstddef>
#include <vector>

namespace qtrace::experiments {

// A run to be done: its place in the config, its turn in the order of execution, from 1.
struct Turn {
  std::size_t place = 0;
  int order = 0;
  int repetition = 0;  // how many runs of its configuration come before
};

// All runs: the first seed of every configuration, then the second of every configuration, so that a machine
// that slows down or speeds up treats all configurations alike.
std::vector<Turn> execution_order(const Experiment& experiment);

// The turns that the choices leave. Throws Error where no run's id fits the pattern.
std::vector<Turn> chosen_turns(const Experiment& experiment, const RunChoices& choices);

// A turn, or a part of one: up to a frame.
struct Step {
  Turn turn;
  int until = 0;
};

// The first runs of all configurations grow together in `rounds` rounds: up to 1/2, 1/4, ... of their frames
// before the last, each rounded up to a snapshot, so that whenever time is up every configuration has about
// as much as any other. Further repetitions are done in one go, and so is everything in one round.
std::vector<Step> steps_of(const Experiment& experiment, const std::vector<Turn>& turns, int rounds);

// How many rounds: as many as bring the first one, of `seconds` for all configurations in full, to this share
// of the budget.
inline constexpr double kFirstRound = 0.1;
inline constexpr int kMostRounds = 12;
int rounds_for(double seconds, double budget);

}  // namespace qtrace::experiments
