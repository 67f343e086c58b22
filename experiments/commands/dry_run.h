// `qtrace run --dry-run`: what is to be done, what is there, and what it will take.
#pragma once

#include "experiments/study/experiment.h"

#include <string>

namespace qtrace::experiments {

// The chosen runs as text: id, scene, size, frames, method and state of each, the references that they need,
// the time that is left by some frames of each configuration, and the room on the disk. Writes nothing.
std::string dry_run(const Experiment& experiment, const gpu::Context& context, SceneStore& scenes,
                    const RunChoices& choices, Progress& progress);

}  // namespace qtrace::experiments
