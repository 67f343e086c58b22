// `qtrace inspect`: pictures of what a run's table has learned, beside what is true.
#pragma once

#include "experiments/commands/subcommand.h"
#include "experiments/runtime/progress.h"

#include <optional>
#include <string>
#include <vector>

namespace qtrace::experiments {

struct InspectOptions {
  std::string folder;      // of a run
  std::vector<int> pixel;  // x, y; empty: the middle of the image
  int samples = 64;        // paths per pixel of the hemisphere
  std::optional<int> frame;
  std::string device;
};

// Writes inspect/cells.exr and inspect/hemisphere_X_Y.exr into the folder and returns figures as a table.
//   cells.exr       cell (-1: none), visits (over the cell's direction bins), R, G, B (false colours)
//   hemisphere.exr  bin (-1: outside the disk), learned, true.R, .G, .B and true_bin (averaged over bin and
//   channels);
//                   the projection is described in engine/tracer/inspection.h
// Throws Error that names what is wrong.
std::string inspect_run(const InspectOptions& options, Progress& progress);

void add_inspect_command(CLI::App& app, Action& action);

}  // namespace qtrace::experiments
