// `qtrace gltf`: what becomes of everything that a scene's file may hold.
#pragma once

#include "experiments/commands/subcommand.h"

namespace qtrace::experiments {

void add_gltf_command(CLI::App& app, Action& action);

}  // namespace qtrace::experiments
