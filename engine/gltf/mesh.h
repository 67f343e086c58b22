#pragma once

#include "engine/gltf/node.h"
#include "engine/gltf_document/limits.h"
#include "engine/scene/scene.h"

#include <cstddef>
#include <vector>

namespace qtrace::gltf {

// Before anything walks through them. Error for more than `limits`.
std::size_t count_triangles(const Source& source, const std::vector<PlacedNode>& nodes,
                            const SceneLimits& limits);

// Fills scene.triangles and scene.objects, and appends glTF's default material where one is needed.
// Warnings name the primitives, triangles and normals that cannot be used. Returns the largest coordinate of
// a position before its node moved it, which says how exactly the file has it.
float add_objects(Source& source, const std::vector<PlacedNode>& nodes, Scene& scene);

}  // namespace qtrace::gltf
