// All techniques that make one path have weights that sum to one: paths of the camera whose last event is
// joined to a point of a lamp, each made in every way that there is.
#pragma once

#include "engine/core/settings.h"

#include <string>

namespace qtrace::independent {

// In a room of feature_rooms.h, with a table that a few frames have taught, for paths of one to three events:
// expects enough of every length, light paths that count among them, and sums of one to 1e-5.
void expect_sums_of_one(const std::string& room, Sampler sampler, Nee nee, LightPaths paths);

}  // namespace qtrace::independent
