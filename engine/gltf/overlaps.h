// Surfaces that overlap in one plane, as the lamp of the Cornell box and its ceiling.
#pragma once

#include "engine/gltf_document/source.h"
#include "engine/scene/scene.h"

namespace qtrace::gltf {

// Which of two surfaces in one plane a ray meets is a matter of rounding. Half of a lamp's light is lost so,
// and what light samples find differs from what paths find. So what emits wins, and of two that do not, with
// different materials and to the same side, the smaller one, as a rug on a floor: the other is cut out there,
// whatever their order. What emits alike counts once. A warning names both objects, and the area. Error where
// two overlap that emit, and not alike. Two surfaces are in one plane where they lie apart by no more than
// the rounding of a hit. Scenes without this stay as they are, to the bit; so do bodies that merely touch.
void cut_overlaps(Source& source, Scene& scene);

}  // namespace qtrace::gltf
