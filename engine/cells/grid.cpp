#include "engine/cells/grid.h"

#include "engine/cells/clip.h"

#include <glm/common.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace qtrace {
namespace {

// A bit for each axis that a normal may be nearest to, whatever its sign.
using Axes = std::uint32_t;

// Boxes reach this far into their neighbours, in boxes and in parts of the largest coordinate: the device
// finds a hit's box in single precision.
constexpr double kBoxSlack = 1e-3;
constexpr double kCoordinateSlack = 32.0 / 16777216.0;
constexpr double kNormalSlack = 1e-4;

Axes nearest_axes(glm::dvec3 normal) {
  const glm::dvec3 size = glm::abs(normal);
  Axes axes = 0;
  for (int k = 0; k < 3; ++k) {
    if (size[k] >= std::max({size.x, size.y, size.z}) - kNormalSlack) axes |= 1U << k;
  }
  return axes;
}

// Whether a normal of the polygon has its largest component along `side` of axis k.
bool can_point_along(Polygon polygon, int k, double side) {
  for (const int j : {(k + 1) % 3, (k + 2) % 3}) {
    for (const double other : {-1.0, 1.0}) {
      polygon = clip(
          polygon, [&](const Corner& c) { return side * c.normal[k] + other * c.normal[j] + kNormalSlack; });
    }
  }
  return !polygon.empty();
}

Axes axes_of(const Polygon& polygon) {
  Axes axes = 0;
  for (int k = 0; k < 3; ++k) {
    if (can_point_along(polygon, k, 1) || can_point_along(polygon, k, -1)) axes |= 1U << k;
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
  struct Range {
    std::uint32_t first;
    std::uint32_t last;
  };

  Range touched(const Polygon& polygon, int k) const {
    const auto [low, high] = std::ranges::minmax(polygon, {}, [k](const Corner& c) { return c.position[k]; });
    const double most = grid_.frame.boxes[k] - 1;
    const auto box = [most](double x) {
      return static_cast<std::uint32_t>(std::clamp(std::floor(x), 0.0, most));
    };
    return {box(low.position[k] - slack_), box(high.position[k] + slack_)};
  }

  // What of the polygon lies in layer `i` of boxes along axis k.
  Polygon layer(const Polygon& polygon, int k, double i) const {
    const Polygon above = clip(polygon, [&](const Corner& c) { return c.position[k] - i + slack_; });
    return clip(above, [&](const Corner& c) { return i + 1 - c.position[k] + slack_; });
  }

  // Corners in units of boxes.
  Polygon polygon_of(const Triangle& t) {
    const GridFrame& frame = grid_.frame;
    Polygon polygon;
    double largest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec3 p = glm::dvec3(t.position[i]) - glm::dvec3(frame.origin);
      polygon.push_back({p * double{frame.boxes_per_unit}, glm::dvec3(t.normal[i])});
      for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(double{t.position[i][k]}));
    }
    slack_ = kBoxSlack + kCoordinateSlack * largest * frame.boxes_per_unit;
    return polygon;
  }

  void add(const Triangle& triangle) {
    const Polygon whole = polygon_of(triangle);
    const Axes face = nearest_axes(glm::normalize(area_vector(triangle.position)));
    const Axes anywhere = axes_of(whole) | face;
    const Range zs = touched(whole, 2);
    for (std::uint32_t z = zs.first; z <= zs.last; ++z) {
      const Polygon slice = layer(whole, 2, z);
      if (slice.empty()) continue;
      const Range ys = touched(slice, 1);
      for (std::uint32_t y = ys.first; y <= ys.last; ++y) {
        const Polygon bar = layer(slice, 1, y);
        if (bar.empty()) continue;
        const Range xs = touched(bar, 0);
        for (std::uint32_t x = xs.first; x <= xs.last; ++x) {
          const Polygon piece = layer(bar, 0, x);
          if (piece.empty()) continue;
          mark({x, y, z}, std::has_single_bit(anywhere) ? anywhere : axes_of(piece) | face);
        }
      }
    }
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
  double slack_ = 0;  // of the triangle in hand
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
