#include "engine/cells/grid.h"

#include <glm/common.hpp>

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace qtrace {
namespace {

// A bit for each axis that a normal may be nearest to, whatever its sign.
using Axes = std::uint32_t;

Axes nearest_axes(glm::dvec3 normal) {
  const glm::dvec3 size = glm::abs(normal);
  Axes axes = 0;
  for (int k = 0; k < 3; ++k) {
    if (size[k] >= std::max({size.x, size.y, size.z}) - kNormalSlack) axes |= 1U << k;
  }
  return axes;
}

Axes axes_of(const Polygon& polygon) {
  Axes axes = 0;
  for (int k = 0; k < 3; ++k) {
    if (!pointing_along(polygon, k, 1).empty() || !pointing_along(polygon, k, -1).empty()) axes |= 1U << k;
  }
  return axes;
}

class GridBuilder {
 public:
  GridBuilder(const Scene& scene, int resolution) {
    grid_.frame = grid_frame(scene, resolution);
    grid_.rows.assign(grid_.frame.entries(), kNoRow);
    for (const Triangle& triangle : scene.triangles) add(triangle);
    number_rows();
  }

  CellGrid take() { return std::move(grid_); }

 private:
  void add(const Triangle& triangle) {
    const BoxedTriangle whole = boxed(grid_.frame, triangle);
    const Axes face = nearest_axes(glm::normalize(area_vector(triangle.position)));
    const Axes anywhere = axes_of(whole.polygon) | face;
    for_each_piece(grid_.frame, whole, [&](glm::uvec3 box, const Polygon& piece) {
      mark(box, std::has_single_bit(anywhere) ? anywhere : axes_of(piece) | face);
    });
  }

  void mark(glm::uvec3 box, Axes axes) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      if ((axes >> k & 1U) == 0) continue;
      for (const std::uint32_t side : {0U, 1U}) grid_.rows[grid_.frame.entry(box, 2 * k + side)] = 0;
    }
  }

  void number_rows() {
    const GridFrame& frame = grid_.frame;
    for (std::size_t i = 0; i < grid_.rows.size(); ++i) {
      if (grid_.rows[i] == kNoRow) continue;
      grid_.rows[i] = static_cast<std::uint32_t>(grid_.cells.size());
      const std::size_t box = i / kGridNormals;
      const std::size_t layer_size = std::size_t{frame.boxes.x} * frame.boxes.y;
      const glm::dvec3 corner(box % frame.boxes.x, box % layer_size / frame.boxes.x, box / layer_size);
      GridCell cell;
      cell.centre = glm::vec3(glm::dvec3(frame.origin) + (corner + 0.5) / double{frame.boxes_per_unit});
      cell.normal[static_cast<int>(i % kGridNormals / 2)] = i % 2 == 0 ? 1.0F : -1.0F;
      grid_.cells.push_back(cell);
    }
  }

  CellGrid grid_;
};

}  // namespace

GridFrame grid_frame(const Scene& scene, int resolution) {
  glm::vec3 lo(std::numeric_limits<float>::infinity());
  glm::vec3 hi = -lo;
  for (const Triangle& t : scene.triangles) {
    for (const glm::vec3& p : t.position) {
      lo = glm::min(lo, p);
      hi = glm::max(hi, p);
    }
  }
  const glm::dvec3 size = glm::dvec3(hi) - glm::dvec3(lo);
  const double per_unit = resolution / std::max({size.x, size.y, size.z});
  const glm::dvec3 boxes = glm::clamp(glm::ceil(size * per_unit), 1.0, double(resolution));
  return {lo, static_cast<float>(per_unit), glm::uvec3(boxes)};
}

CellGrid build_grid(const Scene& scene, int resolution) { return GridBuilder(scene, resolution).take(); }

}  // namespace qtrace
