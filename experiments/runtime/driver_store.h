// How shaders are compiled for a driver: measured once, kept for the next process, and the same for all of an
// experiment. Images are the same whatever is chosen; times are not.
#pragma once

#include "engine/gpu/context.h"
#include "experiments/files/json.h"
#include "experiments/runtime/progress.h"

#include <filesystem>
#include <optional>
#include <string>

namespace qtrace::experiments {

// "fetch=image,stack=registers,work_threads=2": any of them, the others as in `others`. Throws Error.
gpu::DriverChoices parse_choices(const std::string& text, const gpu::DriverChoices& others);

// Sets the context's choices: as the environment variable QTRACE_DRIVER says, else as they were measured by
// this program on this driver before, else as they are measured now and kept, in $XDG_CACHE_HOME/qtrace or
// ~/.cache/qtrace. A file there that cannot be read or written is as none.
void choose_driver(gpu::Context& context, Progress& progress);

// The choices in a manifest's device (device_json), where it is of the same driver and as many threads; and
// sets them unless QTRACE_DRIVER rules.
void keep_choices(gpu::Context& context, const Json& device);

// For an experiment whose results are in the folder: those of its manifest, where there is one. Shards, which
// may start at the same time and have none yet, agree on those of the first of them, in the file
// .driver.json.
void keep_choices_of(gpu::Context& context, const std::filesystem::path& results, bool is_shard);

}  // namespace qtrace::experiments
