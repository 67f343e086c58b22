// The parts of which manifests are made: who wrote it, when, on what, and how figures are defined.
#pragma once

#include "engine/gpu/context.h"
#include "experiments/files/json.h"
#include "experiments/runtime/scene_store.h"

#include <filesystem>
#include <string>

namespace qtrace::experiments {

// Of the files of results, in every manifest: raised when a column or key is removed or changes its meaning,
// so that readers (analysis/load.py) can tell; new ones do not raise it. Results without it are from before
// it.
constexpr int kResultsSchema = 2;

std::string utc_now();  // ISO 8601, seconds

Json program_json();  // version and commit
Json device_json(const gpu::DeviceInfo& device);
// `folder`: of the manifest, from which the scene's files are found again when all are moved together.
Json scene_json(const LoadedScene& scene, const std::filesystem::path& folder);
std::string timing_note();  // one sentence: what the times hold and what they leave out

// "llvmpipe ..., OpenGL ..., software: computes on the CPU".
std::string device_text(const gpu::DeviceInfo& device);

}  // namespace qtrace::experiments
