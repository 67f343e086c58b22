#include "engine/cells/grid_frame.h"

#include <algorithm>
#include <cmath>

namespace qtrace {
namespace {

// Boxes reach this far into their neighbours, in boxes and in parts of the largest coordinate: the device
// finds a hit's box in single precision.
constexpr double kBoxSlack = 1e-3;
constexpr double kCoordinateSlack = 32.0 / 16777216.0;

struct Range {
  std::uint32_t first;
  std::uint32_t last;
};

Range touched(const GridFrame& frame, const Polygon& polygon, double slack, int k) {
  const auto [low, high] = std::ranges::minmax(polygon, {}, [k](const Corner& c) { return c.position[k]; });
  const double most = frame.boxes[k] - 1;
  const auto box = [most](double x) {
    return static_cast<std::uint32_t>(std::clamp(std::floor(x), 0.0, most));
  };
  return {box(low.position[k] - slack), box(high.position[k] + slack)};
}

// What of the polygon lies in layer `i` of boxes along axis k.
Polygon layer(const Polygon& polygon, double slack, int k, double i) {
  const Polygon above = clip(polygon, [&](const Corner& c) { return c.position[k] - i + slack; });
  return clip(above, [&](const Corner& c) { return i + 1 - c.position[k] + slack; });
}

}  // namespace

BoxedTriangle boxed(const GridFrame& frame, const Triangle& triangle) {
  BoxedTriangle result;
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 p = glm::dvec3(triangle.position[i]) - glm::dvec3(frame.origin);
    result.polygon.push_back({p * double{frame.boxes_per_unit}, glm::dvec3(triangle.normal[i])});
    for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(double{triangle.position[i][k]}));
  }
  result.slack = kBoxSlack + kCoordinateSlack * largest * frame.boxes_per_unit;
  return result;
}

void for_each_piece(const GridFrame& frame, const BoxedTriangle& triangle,
                    const std::function<void(glm::uvec3 box, const Polygon& piece)>& visit) {
  const double slack = triangle.slack;
  const Range zs = touched(frame, triangle.polygon, slack, 2);
  for (std::uint32_t z = zs.first; z <= zs.last; ++z) {
    const Polygon slice = layer(triangle.polygon, slack, 2, z);
    if (slice.empty()) continue;
    const Range ys = touched(frame, slice, slack, 1);
    for (std::uint32_t y = ys.first; y <= ys.last; ++y) {
      const Polygon bar = layer(slice, slack, 1, y);
      if (bar.empty()) continue;
      const Range xs = touched(frame, bar, slack, 0);
      for (std::uint32_t x = xs.first; x <= xs.last; ++x) {
        const Polygon piece = layer(bar, slack, 0, x);
        if (!piece.empty()) visit({x, y, z}, piece);
      }
    }
  }
}

Polygon pointing_along(Polygon polygon, int k, double side) {
  for (const int j : {(k + 1) % 3, (k + 2) % 3}) {
    for (const double other : {-1.0, 1.0}) {
      polygon = clip(
          polygon, [&](const Corner& c) { return side * c.normal[k] + other * c.normal[j] + kNormalSlack; });
    }
  }
  return polygon;
}

}  // namespace qtrace
