// The cells of a scene on the device: what find_cell() of shaders/cells.glsl searches.
#pragma once

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

// What row i of a table stands for.
struct CellState {
  glm::vec3 position{0.0F};
  glm::vec3 normal{0.0F};  // unit, out of the surface on the side that the cell is on
  std::uint32_t object = 0;
};

class CellBuffers {
 public:
  CellBuffers(const Scene& scene, const RlSettings& settings);
  // Voronoi cells of sites of one's own.
  explicit CellBuffers(CellSites sites);

  void bind() const;

  std::uint32_t count() const { return static_cast<std::uint32_t>(states_.size()); }
  // By index; two for each Voronoi site, front and back of the surface.
  const std::vector<CellState>& states() const { return states_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  std::size_t bytes() const { return sites_.bytes() + ranges_.bytes(); }

  // Cells of a scene, before anything is built on the device.
  static std::size_t count(const Scene& scene, const RlSettings& settings);

 private:
  CellBuffers(const CellSites& sites, const std::vector<SiteNode>& nodes);

  std::vector<CellState> states_;
  std::vector<std::string> warnings_;
  gpu::Buffer sites_;
  gpu::Buffer ranges_;
};

}  // namespace qtrace
