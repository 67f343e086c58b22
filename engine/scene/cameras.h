// Cameras that no file has, and what a camera sees.
#pragma once

#include "engine/scene/scene.h"
#include "engine/scene/view.h"

#include <vector>

namespace qtrace {

// Of a scene whose positions have their origin at `origin` of the file's world. Error where the place has no
// direction to look or no up.
Camera placed_camera(const CameraPlace& place, const glm::dvec3& origin);

// From the front (+z) and 15 degrees above, with all of the triangles in a picture of this aspect ratio and a
// margin of a twentieth. In the file's world, as above. The triangles must span an area.
CameraPlace fitting_place(const std::vector<Triangle>& triangles, const glm::dvec3& origin, double aspect);

// Whether a triangle, or part of one, is within the picture at a depth from `near` to `far`: the distance
// along the viewing direction. Whatever is in front of it does not count.
bool shows_at_depth(const Scene& scene, double aspect, double near, double far);

}  // namespace qtrace
