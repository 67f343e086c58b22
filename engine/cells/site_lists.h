// For every box of a grid over an object, and every axis that a normal there can be nearest to: the sites
// that can be the nearest one that qualifies. Looking through a short list finds what a search through all
// sites finds.
#pragma once

#include "engine/cells/grid_frame.h"
#include "engine/cells/site_tree.h"
#include "engine/cells/sites.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <vector>

namespace qtrace {

inline constexpr std::uint32_t kMostListedSites = 120;      // poles of spheres have that many
inline constexpr std::uint32_t kMostBoxesAlongAxis = 1023;  // ten bits

struct ObjectLists {
  GridFrame frame;
  std::uint32_t first_entry = 0;  // of SiteLists::starts
};

struct ListedSite {
  std::uint32_t site = 0;    // counted within the object
  bool always_fits = false;  // qualifies for every normal that the surface has there
};

struct SiteLists {
  std::vector<ObjectLists> objects;
  std::vector<std::uint32_t> starts;  // entry e lists sites[starts[e]] up to sites[starts[e + 1]], ascending
  std::vector<ListedSite> sites;
  // Whether every piece of the surface has its list. It has none where more than kMostListedSites can win,
  // and where normals are anything (interpolated ones that cancel, a cone of nearly a hemisphere): there the
  // tree is searched.
  bool complete = true;
};

// `cells` in the order of `nodes`. A list is empty where no surface lies, where no site qualifies, and where
// the surface has none.
//
// A site is left out only where another is nearer to every point of the surface in the box and qualifies for
// every normal that the surface has there.
SiteLists build_site_lists(const Scene& scene, const CellSites& cells, const std::vector<SiteNode>& nodes,
                           double cell_normal_threshold);

}  // namespace qtrace
