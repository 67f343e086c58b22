// `qtrace status`: how far the experiments in a results folder are.
#pragma once

#include "experiments/commands/subcommand.h"

#include <filesystem>
#include <string>

namespace qtrace::experiments {

// `folder`: results/<experiment>, or results with several of them. Throws Error where there are none.
std::string status_text(const std::filesystem::path& folder);

void add_status_command(CLI::App& app, Action& action);

}  // namespace qtrace::experiments
