// A glTF file as the rest of the loader reads it: checked, decoded and parsed.
#pragma once

#include "engine/gltf_document/file.h"
#include "engine/gltf_document/limits.h"
#include "engine/gltf_document/source.h"

#include <filesystem>

namespace qtrace::gltf {

// Every index in it is within its array, every buffer is loaded, and what was sparse, quantized or compressed
// stands in plain accessors. `file` names the source in messages; buffers in files of their own are looked
// for beside it. Error, named, for a file that is not valid glTF or holds what the table of support refuses.
Source read_document(FileContent content, const std::filesystem::path& file, const SceneLimits& limits);

}  // namespace qtrace::gltf
