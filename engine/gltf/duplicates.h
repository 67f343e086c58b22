// Emitting triangles that lie exactly on others.
#pragma once

#include "engine/gltf_document/source.h"
#include "engine/scene/scene.h"

namespace qtrace::gltf {

// Of emitting triangles with the same three corners that face the same side, keeps the first and warns of the
// others: light sampling would count each, and which of them a ray meets would be a matter of rounding. Error
// that names both where two do not emit alike, so that one would hide the other's light. All others are the
// matter of overlaps.h.
void drop_duplicates(Source& source, Scene& scene);

}  // namespace qtrace::gltf
