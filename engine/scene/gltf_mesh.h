#pragma once

#include "engine/scene/gltf_node.h"
#include "engine/scene/scene.h"

#include <vector>

namespace qtrace::gltf {

// Fills scene.triangles and scene.objects, and appends glTF's default material where one is needed.
// Warnings name the primitives, triangles and normals that cannot be used.
void add_objects(Source& source, const std::vector<PlacedNode>& nodes, Scene& scene);

}  // namespace qtrace::gltf
