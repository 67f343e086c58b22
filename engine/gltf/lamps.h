// Emitting triangles in the plane of larger ones, as the lamp of the Cornell box in its ceiling.
#pragma once

#include "engine/gltf/source.h"
#include "engine/scene/scene.h"

namespace qtrace::gltf {

// Which of two surfaces in one plane a ray meets is a matter of rounding, so that half of a lamp's light is
// lost there, and what light samples find differs from what paths find. So what emits wins: it is cut out of
// what does not emit, and out of what emits alike and comes after it; a warning names both, and the area.
// Error where two that do not emit alike overlap. Two surfaces are in one plane where they lie apart by no
// more than the rounding of a hit. Scenes without this stay as they are, to the bit.
void cut_out_lamps(Source& source, Scene& scene);

}  // namespace qtrace::gltf
