// Triangles that lie exactly on others.
#pragma once

#include "engine/scene/gltf_source.h"
#include "engine/scene/scene.h"

namespace qtrace::gltf {

// Of triangles with the same three corners, in any order, keeps the first and warns of the others. Which of
// them a ray meets would be a matter of rounding, and light sampling would count each. Error that names both
// where they do not emit alike, so that light would be lost.
void drop_duplicates(Source& source, Scene& scene);

}  // namespace qtrace::gltf
