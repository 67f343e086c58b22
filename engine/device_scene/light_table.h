// The lights as next event estimation chooses among them.
#pragma once

#include "engine/core/settings.h"
#include "engine/gpu/structs.h"
#include "engine/scene/scene.h"

#include <vector>

namespace qtrace::gpu {

// About the scene's triangles and lights that have a place.
struct SceneSphere {
  glm::dvec3 centre{0};
  double radius = 1;
};

struct LightTable {
  // Connected emitting surfaces, in the scene's order; then lights without a surface; then the environment's
  // image.
  std::vector<Light> lights;
  std::vector<LightTriangle> triangles;  // light by light
  std::vector<uint> triangle_of;  // by scene triangle, index in `triangles`; NO_LIGHT where it does not emit
  bool has_sky = false;           // the last light is an image of the environment that is not black
  float brightest = 0;            // mean radiance of the brightest
  double power = 0;               // of all of them: area times mean radiance, summed over the faces that emit
  SceneSphere sphere;
};

// A light is chosen in proportion to its power (of a surface area x mean radiance, twice that where both
// faces emit), or each alike; a surface's triangles in proportion to theirs. `choice`: learned starts from
// power.
LightTable build_light_table(const Scene& scene, LightChoice choice);

// In the same units, of an environment of this mean radiance about a scene of this radius.
double power_of_environment(double mean_radiance, double scene_radius);

// Length by which rays leave a triangle (OFFSET_FRACTION of its largest coordinate).
float ray_offset(const Triangle& triangle);

}  // namespace qtrace::gpu
