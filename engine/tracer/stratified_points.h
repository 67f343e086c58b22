// The Sobol' points of one frame, before a pixel scrambles them (shaders/sampling/sobol.glsl).
#pragma once

#include "engine/gpu/structs.h"

#include <cstdint>
#include <vector>

namespace qtrace {

// Point `index` of sequence `sequence`, for the camera and the first `events` scattering events: four words
// for each block of random words (BLOCK_... in structs.glsl), with the first binary digit of each lowest.
// Words that belong together are coordinates of one point; groups of them are padded against each other, each
// with the index shuffled in its own way (Burley 2020, section 5): with scrambles alone their leading digits
// would be tied to one another within a pixel, whose mean would never converge.
std::vector<gpu::uvec4> stratified_points(std::uint32_t seed, std::uint32_t sequence, std::uint32_t index,
                                          int events);

}  // namespace qtrace
