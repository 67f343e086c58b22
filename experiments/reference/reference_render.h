// Renders a reference, or goes on with one from the state that is kept beside its file.
#pragma once

#include "engine/core/check.h"
#include "engine/gpu/context.h"
#include "experiments/files/state_file.h"
#include "experiments/reference/reference.h"
#include "experiments/runtime/progress.h"
#include "experiments/runtime/scene_store.h"
#include "experiments/runtime/stopper.h"

#include <filesystem>
#include <functional>
#include <optional>

namespace qtrace::experiments {

// The state beside a reference's file; nothing where there is none, or after `complain` where it is damaged
// or belongs to another reference.
std::optional<StoredState> read_reference_state(const std::filesystem::path& file, const ReferenceSpec& spec,
                                                const std::function<void(const Error&)>& complain);

// Renders until the wish is settled and writes the state, the file (mean, variance, and as layers half1 and
// half2 the means of the odd and of the even frames) and the JSON beside it, each whole or not at all. The
// state is written on the way, too, so that a killed process loses little. Whatever was interrupted or
// extended, the image has the bits of one rendered in one go, on one device and driver. Returns whether there
// was a state to go on from. Throws Error, gpu::ContextLost, and Stopped, with its state written.
bool render_reference(const gpu::Context& context, const ReferenceSpec& spec, const LoadedScene& scene,
                      const std::filesystem::path& file, const Stopper& stopper, Progress& progress);

}  // namespace qtrace::experiments
