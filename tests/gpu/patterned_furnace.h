#pragma once

#include "engine/scene/scene.h"

namespace qtrace::test {

// Radiance that the walls of patterned_furnace() show, everywhere and in all directions.
inline constexpr double kWallRadiance[6] = {1.0, 2.0, 1.2, 1.6, 1.1, 1.8};

// A closed cube (as furnace_box) of Lambert panels whose emission is such that wall w, an object, shows the
// radiance kWallRadiance[w]: emission = radiance - albedo * what the other walls send to the panel's middle.
Scene patterned_furnace();

}  // namespace qtrace::test
