// Surfaces that overlap in one plane, as the lamp of the Cornell box and its ceiling.
#pragma once

#include "engine/gltf_document/source.h"
#include "engine/scene/scene.h"

#include <cstddef>

namespace qtrace::gltf {

// Which of two surfaces in one plane a ray meets is a matter of rounding: half of a lamp's light is lost so,
// and light samples find something else than paths. So one of them is seen, whatever their order, and the
// other is cut out there: what emits wins, and of two that do not, with different materials, the one that
// lies more wholly on the other, as a rug on a floor. Where the one that is seen lets light pass, as the
// glass before a picture, it is moved towards its front by the rounding instead. What emits alike counts
// once. Two that face opposite sides and cover each other, as the front and the back of a leaf, are moved
// apart by the rounding: each is seen from the side that it faces. A warning names both objects, and the
// area. Solids that merely touch stay as they are. Error where two lamps overlap that do not emit alike, or
// where more than `max_triangles` would be left.
//
// In one plane means apart by no more than the rounding of a hit. `extent` is the largest coordinate that
// positions had before nodes moved them: it rounded them, too. Scenes without such surfaces stay as they are,
// to the bit.
void cut_overlaps(Source& source, Scene& scene, float extent, std::size_t max_triangles);

}  // namespace qtrace::gltf
