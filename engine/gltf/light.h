// Lights that no surface has (KHR_lights_punctual).
#pragma once

#include "engine/gltf/node.h"
#include "engine/scene/lights.h"

#include <vector>

namespace qtrace::gltf {

// One for each of `nodes` that shows a light which shines at all. A scale of the node moves a light and does
// not change it. Error for numbers out of their range, and for a direction that the node has squeezed flat.
std::vector<PunctualLight> read_lights(Source& source, const std::vector<PlacedNode>& nodes);

}  // namespace qtrace::gltf
