#pragma once

#include "engine/gltf/node.h"
#include "engine/scene/scene.h"

#include <vector>

namespace qtrace::gltf {

// The first camera among `nodes`; a warning names each further one.
Camera read_camera(Source& source, const std::vector<PlacedNode>& nodes);

}  // namespace qtrace::gltf
