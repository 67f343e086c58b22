// The cells of a scene on the device: what find_cell() of shaders/learning/cells.glsl searches.
#pragma once

#include "engine/cells/grid.h"
#include "engine/cells/site_lists.h"
#include "engine/cells/site_tree.h"
#include "engine/cells/sites.h"
#include "engine/core/settings.h"
#include "engine/gpu/buffer.h"
#include "engine/gpu/structs.h"
#include "engine/scene/scene.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace qtrace {

inline constexpr std::uint32_t kNoObject = 0xffffffff;

// What state i of a table stands for.
struct CellState {
  glm::vec3 position{0.0F};
  glm::vec3 normal{0.0F};    // unit, out of the surface on the side that the cell is on
  std::uint32_t object = 0;  // kNoObject where objects share it
};

class CellBuffers {
 public:
  CellBuffers(const Scene& scene, const RlSettings& settings);
  // Voronoi cells of sites of one's own, without lists.
  explicit CellBuffers(CellSites sites);
  explicit CellBuffers(const CellGrid& grid);

  void bind() const;

  std::uint32_t count() const { return static_cast<std::uint32_t>(states_.size()); }
  // By index; two for each Voronoi site, front and back of the surface; of a grid's box, its centre and the
  // axis that normals there are nearest to.
  const std::vector<CellState>& states() const { return states_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  // Whether the lists of sites find every cell, so that shaders need no other search (define
  // LISTS_ARE_COMPLETE).
  bool lists_are_complete() const { return lists_are_complete_; }
  const GridFrame& grid() const { return grid_; }  // without boxes unless cells are of a grid
  std::size_t bytes() const { return cells_.bytes() + lists_.bytes(); }

  // Throws Error where the device cannot hold what find_cell() reads.
  static void check_size(const Scene& scene, const RlSettings& settings);
  // Cells of a scene, before anything is built on the device.
  static std::size_t count(const Scene& scene, const RlSettings& settings);

 private:
  // In the order of the trees.
  CellBuffers(const CellSites& sites, const std::vector<SiteNode>& nodes, const SiteLists& lists);
  static CellBuffers voronoi(const Scene& scene, const RlSettings& settings);

  std::vector<CellState> states_;
  std::vector<std::string> warnings_;
  bool lists_are_complete_ = false;
  GridFrame grid_;
  gpu::Buffer cells_;  // sites, or the rows of a grid's entries
  gpu::Buffer lists_;  // of the sites' ranges, and of the sites that can be nearest
};

}  // namespace qtrace
