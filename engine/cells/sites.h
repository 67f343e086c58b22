// Voronoi sites on the surfaces: the states of the Q-table (Goswami 2020, section 4.3.1).
#pragma once

#include "engine/core/settings.h"
#include "engine/scene/scene.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace qtrace {

struct CellSite {
  glm::vec3 position{0.0F};
  glm::vec3 normal{0.0F};  // unit, on the front side of the surface
};

struct CellSites {
  std::vector<CellSite> sites;        // object by object
  std::vector<std::uint32_t> first;   // first[o] .. first[o + 1]: the sites of object o
  std::vector<std::string> warnings;  // objects whose sites could not stand as asked
};

// site_counts() sites on every object, at Hammersley points (van der Corput 1935; base 2) mapped
//   uv:   through the object's UV map; points beside its islands are replaced by taking a denser set, so that
//         every site lives. Where islands overlap, the points alternate between them. An object without
//         UV map, or with one that covers nearly nothing, is placed by area instead, with a warning.
//   area: over the object's triangles in proportion to their area.
CellSites place_sites(const Scene& scene, const RlSettings& settings);

}  // namespace qtrace
