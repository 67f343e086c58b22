#pragma once

#include "engine/gltf_document/limits.h"
#include "engine/scene/scene.h"
#include "engine/scene/view.h"

#include <filesystem>
#include <span>

namespace qtrace {

// Reads a .gltf or .glb file. Throws Error with the file, the node or accessor, what is wrong and what
// would be right: unreadable or truncated files, accessors outside their buffers, indices outside the
// vertex array, non-finite numbers, buffers outside the scene's folder, no camera where the view names no
// place for one, required extensions that are not supported. What is legal and not modelled
// ends in Scene::warnings, of which there are a hundred at most.
//
// Objects stand in the order of a depth-first walk and are named by the node, else the mesh, else "node 7";
// one that has no triangle of some area is left out. Materials keep the file's order; glTF's default
// material follows as "default" where a primitive names none. A normal of length zero, or one that points
// behind its triangle, gives way to the face normal. Both have a warning.
Scene load_gltf(const std::filesystem::path& file, const View& view = {});

// The same of bytes in memory; `file` is what messages call them, and its folder holds their buffers.
Scene parse_gltf(std::span<const unsigned char> bytes, const std::filesystem::path& file,
                 const View& view = {}, const SceneLimits& limits = {});

}  // namespace qtrace
