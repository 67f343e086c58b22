// Emitting triangles that lie exactly on others.
#pragma once

#include "engine/gltf_document/source.h"
#include "engine/scene/scene.h"

namespace qtrace::gltf {

// Of emitting triangles with the same three corners, in any order, keeps the first and warns of the others:
// light sampling would count each, and which of them a ray meets would be a matter of rounding. Error that
// names both where two do not emit alike, so that one would hide the other's light. Those that do not emit
// stay: solids that touch have them, and they take no light from one another. What emits and what does not is
// told apart elsewhere (overlaps.h).
void drop_duplicates(Source& source, Scene& scene);

}  // namespace qtrace::gltf
