// The lights as next event estimation chooses among them.
#pragma once

#include "engine/core/settings.h"
#include "engine/gpu/structs.h"
#include "engine/scene/scene.h"

#include <vector>

namespace qtrace::gpu {

struct LightTable {
  // Connected emitting surfaces, in the scene's order; then lights without a surface; then the environment's
  // image.
  std::vector<Light> lights;
  std::vector<LightTriangle> triangles;  // light by light
  std::vector<uint> triangle_of;  // by scene triangle, index in `triangles`; NO_LIGHT where it does not emit
  bool has_sky = false;           // the last light is an image of the environment that is not black
  float brightest = 0;            // mean radiance of the brightest
};

// A light is chosen in proportion to its power (of a surface area x mean radiance, twice that where both
// faces emit), or each alike; a surface's triangles in proportion to theirs. `choice`: learned starts from
// power.
LightTable build_light_table(const Scene& scene, LightChoice choice);

// Of a sphere about the scene's triangles and lights that have a place.
double scene_radius(const Scene& scene);

// Length by which rays leave a triangle (OFFSET_FRACTION of its largest coordinate).
float ray_offset(const Triangle& triangle);

}  // namespace qtrace::gpu
