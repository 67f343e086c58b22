// The emitting triangles as next event estimation chooses among them.
#pragma once

#include "engine/core/settings.h"
#include "engine/gpu/structs.h"
#include "engine/scene/scene.h"

#include <vector>

namespace qtrace::gpu {

struct LightTable {
  std::vector<Light> lights;             // connected emitting surfaces, in the scene's order
  std::vector<LightTriangle> triangles;  // light by light
  std::vector<uint> triangle_of;  // by scene triangle, index in `triangles`; NO_LIGHT where it does not emit
  float brightest = 0;            // mean radiance of the brightest
};

// A light is chosen in proportion to its power (area x mean radiance, twice that where both faces emit), or
// each alike; its triangles in proportion to theirs. `choice`: learned starts from power.
LightTable build_light_table(const Scene& scene, LightChoice choice);

// Length by which rays leave a triangle (OFFSET_FRACTION of its largest coordinate).
float ray_offset(const Triangle& triangle);

}  // namespace qtrace::gpu
