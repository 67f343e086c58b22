// The environment's image as the shaders read it and draw directions from it.
#pragma once

#include "engine/gpu/structs.h"
#include "engine/scene/lights.h"

#include <vector>

namespace qtrace::gpu {

// Over all directions and channels; 0 where the whole image is black.
double mean_radiance(const EnvironmentMap& map);

// Row by row; none of a black image. A texel is drawn in proportion to what its bilinear radiance brings: its
// mean over the texel times the texel's solid angle. So no direction with radiance has a density of zero.
std::vector<SkyTexel> build_sky_table(const EnvironmentMap& map);

}  // namespace qtrace::gpu
