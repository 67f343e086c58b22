#pragma once

#include "engine/gltf/node.h"
#include "engine/scene/scene.h"
#include "engine/scene/view.h"

#include <vector>

namespace qtrace::gltf {

// Fills scene.camera: one among `nodes`, the first unless the view names another, or where the view wants it.
// The scene's triangles and its origin are there. Warnings name further cameras where the view names none,
// and what the picture does not have of the file's camera: another aspect ratio, and depths at which it would
// be cut off.
void add_camera(Source& source, const std::vector<PlacedNode>& nodes, const View& view, Scene& scene);

}  // namespace qtrace::gltf
