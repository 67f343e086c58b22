// Lights without a surface (KHR_lights_punctual) as the shaders read them.
#pragma once

#include "engine/gpu/structs.h"
#include "engine/scene/lights.h"

namespace qtrace::gpu {

// Its choice and links are left open.
Light pack_punctual(const PunctualLight& light);

// In the units of power_of_lamp() (light_table.cpp), area times radiance: what it sends into a scene of this
// radius, over pi.
double power_of(const PunctualLight& light, double scene_radius);

// A radiance in whose units contributions of the light are neither vast nor tiny.
double typical_radiance(const PunctualLight& light, double scene_radius);

}  // namespace qtrace::gpu
