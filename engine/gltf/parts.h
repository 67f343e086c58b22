// What each object has of one material: the surfaces that are seen, or cut, as a whole.
#pragma once

#include "engine/gltf/box_tree.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <vector>

namespace qtrace::gltf {

inline bool emits(const Material& material) { return material.emission != glm::vec3(0.0F); }

// What lies behind it in the same plane is seen.
inline bool is_see_through(const Material& material) {
  return material.alpha_mode != AlphaMode::opaque || material.transmission > 0;
}

// Of two that emit: the same everywhere, and to as many sides.
inline bool emit_alike(const Material& a, const Material& b) {
  const auto is_even = [](const Material& material) {
    return !material.texture(TextureSlot::emission) && !is_see_through(material);
  };
  return a.emission == b.emission && a.double_sided == b.double_sided && is_even(a) && is_even(b);
}

struct Part {
  std::uint32_t object = 0;
  std::uint32_t material = 0;
  std::uint32_t look = 0;  // the first material that differs from its own in no more than its name
  bool emits = false;
  bool is_see_through = false;
  bool is_patterned = false;  // it has textures or vertex colours: two that are alike may look different
  double area = 0;
  Box box;  // with the margin around it
};

class Parts {
 public:
  // `margin`: around all boxes.
  Parts(const Scene& scene, float margin);

  // In the order in which their first triangles stand in the scene.
  const std::vector<Part>& all() const { return parts_; }
  std::uint32_t index_of(std::uint32_t triangle) const { return part_of_[triangle]; }
  const Part& of(std::uint32_t triangle) const { return parts_[part_of_[triangle]]; }

  // Whether the order of two surfaces in one plane would show.
  static bool differ(const Part& a, const Part& b) {
    return a.emits || b.emits || a.look != b.look || (&a != &b && (a.is_patterned || b.is_patterned));
  }

  // The triangles that emit, or come into the box of a part that differs from theirs: no others can overlap
  // with one that does.
  std::vector<std::uint32_t> near_others(const Scene& scene, float margin) const;

 private:
  std::vector<Part> parts_;
  std::vector<std::uint32_t> part_of_;  // by triangle
};

}  // namespace qtrace::gltf
