// How many Voronoi sites stand on each object.
#pragma once

#include "engine/core/settings.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <vector>

namespace qtrace {

// sites_per_object each; or, where that is 0, total_sites shared among the objects in proportion to
// their area, so that sites stand about equally far apart all over the scene: at least one each, and rounded
// by largest remainders (Hamilton's method), so that the sum is exact unless there are more objects than
// sites. None on an object without triangles.
std::vector<std::uint32_t> site_counts(const Scene& scene, const RlSettings& settings);

}  // namespace qtrace
