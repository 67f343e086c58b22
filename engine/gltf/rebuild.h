// A scene with other triangles in place of its own.
#pragma once

#include "engine/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace qtrace::gltf {

// `put(i, triangles)` appends what takes the place of triangle i; it is called in their order. Objects that
// have nothing left are omitted.
template <class Put>
void rebuild(Scene& scene, Put put) {
  std::vector<Triangle> triangles;
  std::vector<Object> objects;
  triangles.reserve(scene.triangles.size());
  for (const Object& object : scene.objects) {
    Object rest = object;
    rest.first_triangle = static_cast<std::uint32_t>(triangles.size());
    for (std::uint32_t i = object.first_triangle; i < object.first_triangle + object.triangle_count; ++i) {
      put(i, triangles);
    }
    rest.triangle_count = static_cast<std::uint32_t>(triangles.size()) - rest.first_triangle;
    if (rest.triangle_count == 0) continue;
    for (std::size_t i = rest.first_triangle; i < triangles.size(); ++i) {
      triangles[i].object = static_cast<std::uint32_t>(objects.size());
    }
    objects.push_back(std::move(rest));
  }
  scene.triangles = std::move(triangles);
  scene.objects = std::move(objects);
}

}  // namespace qtrace::gltf
