// The emitting triangles as next event estimation chooses among them.
#pragma once

#include "engine/gpu/structs.h"
#include "engine/scene/scene.h"

#include <vector>

namespace qtrace::gpu {

struct LightTable {
  std::vector<Light> lights;   // emitting triangles, in the scene's order
  std::vector<uint> light_of;  // by scene triangle; NO_LIGHT where it does not emit
};

// Each triangle is chosen in proportion to its power: area x mean radiance, twice that where both faces emit.
LightTable build_light_table(const Scene& scene);

// Length by which rays leave a triangle (OFFSET_FRACTION of its largest coordinate).
float ray_offset(const Triangle& triangle);

}  // namespace qtrace::gpu
