// `qtrace rerun`: does one run again from its manifest, and says whether the bits agree.
#pragma once

#include "experiments/commands/subcommand.h"
#include "experiments/runtime/progress.h"

#include <filesystem>
#include <string>

namespace qtrace::experiments {

struct RerunOptions {
  std::filesystem::path manifest;  // of a finished run: results/<experiment>/<run>/manifest.json
  std::string out;                 // where the new files are kept; empty: nowhere
  std::string device;
};

struct RerunResult {
  std::string text;     // what agrees, what does not, and what differs in program, device and scene
  bool agrees = false;  // all images and tables, to the bit
};

// Renders into `out` or a temporary folder; the old results are read alone. The reference is taken from the
// old results where it is there, which changes no image. Throws Error that names the manifest and what it
// lacks.
RerunResult rerun(const RerunOptions& options, Progress& progress);

void add_rerun_command(CLI::App& app, Action& action);

}  // namespace qtrace::experiments
