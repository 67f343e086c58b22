#include "engine/scene/cameras.h"

#include "engine/core/check.h"
#include "engine/scene/clip.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace qtrace {
namespace {

glm::dvec3 vector_of(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

// A corner of a triangle as the camera sees it: x and y over the half sides of the picture at this depth,
// times the depth for a perspective camera, so that both can be told from the borders without a division.
struct Corner {
  double x, y, depth;
};
using Polygon = std::vector<Corner>;

Corner mixed(const Corner& a, const Corner& b, double x) {
  return {a.x + x * (b.x - a.x), a.y + x * (b.y - a.y), a.depth + x * (b.depth - a.depth)};
}

class Picture {
 public:
  Picture(const Camera& camera, double aspect)
      : camera_from_world_(glm::inverse(glm::dmat4(camera.world_from_camera))),
        is_flat_(camera.film_height > 0) {
    half_height_ = is_flat_ ? static_cast<double>(camera.film_height) / 2
                            : std::tan(static_cast<double>(camera.vertical_fov) / 2);
    half_width_ = half_height_ * aspect;
  }

  bool shows(const Triangle& triangle, double near, double far) const {
    std::array<Corner, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec4 p = camera_from_world_ * glm::dvec4(glm::dvec3(triangle.position[i]), 1);
      corners[i] = {p.x / half_width_, p.y / half_height_, -p.z};
    }
    const auto [least, most] = std::ranges::minmax(corners, {}, &Corner::depth);
    if (least.depth > far || most.depth <= near) return false;
    Polygon polygon(corners.begin(), corners.end());
    const auto border = [this](const Corner& c) { return is_flat_ ? 1.0 : c.depth; };
    polygon = clip(polygon, [&](const Corner& c) { return c.depth - near; });
    polygon = clip(polygon, [&](const Corner& c) { return far - c.depth; });
    polygon = clip(polygon, [&](const Corner& c) { return border(c) - c.x; });
    polygon = clip(polygon, [&](const Corner& c) { return border(c) + c.x; });
    polygon = clip(polygon, [&](const Corner& c) { return border(c) - c.y; });
    polygon = clip(polygon, [&](const Corner& c) { return border(c) + c.y; });
    return polygon.size() >= 3;
  }

 private:
  glm::dmat4 camera_from_world_;
  bool is_flat_;                     // orthographic
  double half_width_, half_height_;  // of the picture; of a perspective camera, at depth 1
};

}  // namespace

Camera placed_camera(const CameraPlace& place, const glm::dvec3& origin) {
  const glm::dvec3 back = vector_of(place.position) - vector_of(place.target);
  check(glm::length(back) > 0,
        "the camera's position and target are both {} {} {}; two places would be right", place.target[0],
        place.target[1], place.target[2]);
  const glm::dvec3 axis = glm::normalize(back);
  const glm::dvec3 up = vector_of(place.up);
  const glm::dvec3 right = glm::cross(up, axis);
  constexpr double kLeastSine = 1e-6;  // between `up` and the viewing direction
  check(glm::length(right) > kLeastSine * glm::length(up) && glm::length(up) > 0,
        "the camera's up {} {} {} lies along its viewing direction; another direction would be right", up.x,
        up.y, up.z);
  const glm::dvec3 unit_right = glm::normalize(right);
  Camera camera;
  camera.world_from_camera =
      glm::mat4(glm::dmat4(glm::dvec4(unit_right, 0), glm::dvec4(glm::cross(axis, unit_right), 0),
                           glm::dvec4(axis, 0), glm::dvec4(vector_of(place.position) - origin, 1)));
  camera.vertical_fov = static_cast<float>(glm::radians(place.vertical_fov));
  return camera;
}

CameraPlace fitting_place(const std::vector<Triangle>& triangles, const glm::dvec3& origin, double aspect) {
  constexpr double kElevation = 15;  // degrees
  constexpr double kMargin = 1.05;
  CameraPlace place;
  const double height = std::tan(glm::radians(place.vertical_fov) / 2);
  const glm::dvec3 back(0, std::sin(glm::radians(kElevation)), std::cos(glm::radians(kElevation)));
  const glm::dvec3 right(1, 0, 0), up = glm::cross(back, right);
  if (triangles.empty()) return {{0, 0, 1}};  // what there is besides is the same from everywhere
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const Triangle& triangle : triangles) {
    for (const glm::vec3& p : triangle.position)
      low = glm::min(low, glm::dvec3(p)), high = glm::max(high, glm::dvec3(p));
  }
  const glm::dvec3 centre = 0.5 * (low + high);
  double distance = 0;
  for (const Triangle& triangle : triangles) {
    for (const glm::vec3& p : triangle.position) {
      const glm::dvec3 v = glm::dvec3(p) - centre;
      const double across = std::max(std::abs(glm::dot(v, right)) / aspect, std::abs(glm::dot(v, up)));
      distance = std::max(distance, glm::dot(v, back) + kMargin * across / height);
    }
  }
  const glm::dvec3 target = centre + origin, position = target + distance * back;
  place.target = {target.x, target.y, target.z};
  place.position = {position.x, position.y, position.z};
  return place;
}

bool shows_at_depth(const Scene& scene, double aspect, double near, double far) {
  const Picture picture(scene.camera, aspect);
  return std::ranges::any_of(scene.triangles,
                             [&](const Triangle& triangle) { return picture.shows(triangle, near, far); });
}

}  // namespace qtrace
