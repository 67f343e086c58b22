// The à-trous filter by the formulas of its paper, in double precision and without a thought for speed.
#pragma once

#include "engine/core/filter_settings.h"
#include "engine/core/image.h"

#include <glm/vec3.hpp>

#include <vector>

namespace qtrace::test {

// The filtered mean, as AtrousFilter::apply() should give it.
std::vector<glm::dvec3> slow_atrous(const FirstHitImage& hits, const RadianceImage& image,
                                    const FilterSettings& settings);

}  // namespace qtrace::test
