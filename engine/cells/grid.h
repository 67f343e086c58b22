// A regular grid of boxes, times the six directions along the axes that a normal can be nearest to: states
// that know nothing of the surfaces (Kim & Kim 2021, "Fast and Lightweight Path Guiding Algorithm on GPU";
// Pan 2019).
#pragma once

#include "engine/cells/grid_frame.h"
#include "engine/scene/scene.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace qtrace {

inline constexpr std::uint32_t kNoRow = 0xffffffff;

struct GridCell {
  glm::vec3 centre{0.0F};
  glm::vec3 normal{0.0F};
};

struct CellGrid {
  GridFrame frame;
  std::vector<std::uint32_t> rows;  // by entry of the frame; kNoRow where no surface can need a cell
  std::vector<GridCell> cells;      // by row
};

// Cubes over the scene's bounds, `resolution` along the longest side.
GridFrame grid_frame(const Scene& scene, int resolution);

// Has a cell wherever a triangle, with its interpolated normal or its face's and seen from either side, can
// lie in a box and have that nearest axis.
CellGrid build_grid(const Scene& scene, int resolution);

}  // namespace qtrace
