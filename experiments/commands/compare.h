// `qtrace compare`: the errors of one image file against another.
#pragma once

#include "experiments/commands/subcommand.h"

#include <filesystem>
#include <string>

namespace qtrace::experiments {

struct CompareOptions {
  std::filesystem::path image;
  std::filesystem::path reference;
  std::string layer{};                 // empty: chosen as exr_layers.h says
  std::string reference_layer{};       // empty: `layer`
  std::filesystem::path heat{};        // empty: no heat map
  std::string heat_metric = "relmse";  // of those that have errors per pixel
  double heat_top = 0;                 // 0: as heat_map.h says
};

// What was compared, and a table of all metrics; the noise floor only where the reference has variance
// channels. Frames of one size are compared where both files have pixels, other files where both have as
// many. Throws Error that names the file: unreadable, no image in it, several, sizes that differ; then
// nothing is written.
std::string compare_files(const CompareOptions& options);

void add_compare_command(CLI::App& app, Action& action);

}  // namespace qtrace::experiments
