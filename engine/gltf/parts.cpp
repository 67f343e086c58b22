#include "engine/gltf/parts.h"

#include <algorithm>
#include <map>
#include <utility>

namespace qtrace::gltf {
namespace {

// Of each material, the first one that looks the same.
std::vector<std::uint32_t> looks_of(const std::vector<Material>& materials) {
  std::vector<Material> nameless = materials;
  for (Material& material : nameless) {
    material.name.clear();
    if (!emits(material)) material.double_sided = false;  // of no consequence then
  }
  std::vector<std::uint32_t> looks;
  for (const Material& material : nameless) {
    looks.push_back(static_cast<std::uint32_t>(std::ranges::find(nameless, material) - nameless.begin()));
  }
  return looks;
}

bool has_textures(const Material& material) {
  return std::ranges::any_of(material.textures, [](const auto& texture) { return texture.has_value(); });
}

bool has_colors(const Scene& scene, const Triangle& triangle) {
  return triangle.attributes != kNoAttributes &&
         scene.attributes[triangle.attributes].color != TriangleAttributes().color;
}

}  // namespace

Parts::Parts(const Scene& scene, float margin) {
  const std::vector<std::uint32_t> looks = looks_of(scene.materials);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> indices;
  part_of_.reserve(scene.triangles.size());
  std::uint32_t index = 0;
  for (const Triangle& triangle : scene.triangles) {
    const bool goes_on = !parts_.empty() && parts_[index].object == triangle.object &&
                         parts_[index].material == triangle.material;
    if (!goes_on) {
      const auto next = static_cast<std::uint32_t>(parts_.size());
      const auto [place, is_new] = indices.try_emplace({triangle.object, triangle.material}, next);
      index = place->second;
      if (is_new) {
        const Material& material = scene.materials[triangle.material];
        Part& part = parts_.emplace_back();
        part.object = triangle.object;
        part.material = triangle.material;
        part.look = looks[triangle.material];
        part.emits = gltf::emits(material);
        part.is_see_through = gltf::is_see_through(material);
        part.is_patterned = has_textures(material);
      }
    }
    parts_[index].is_patterned = parts_[index].is_patterned || has_colors(scene, triangle);
    parts_[index].area += area_of(triangle);
    parts_[index].box.add(box_of(triangle, margin));
    part_of_.push_back(index);
  }
}

std::vector<std::uint32_t> Parts::near_others(const Scene& scene, float margin) const {
  std::vector<Box> boxes;
  for (const Part& part : parts_) boxes.push_back(part.box);
  const BoxTree tree(std::move(boxes));
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < part_of_.size(); ++i) {
    const Part& own = of(i);
    const auto differs = [&](std::size_t other) {
      return other != part_of_[i] && differ(own, parts_[other]);
    };
    if (own.emits || tree.any(box_of(scene.triangles[i], margin), differs)) found.push_back(i);
  }
  return found;
}

}  // namespace qtrace::gltf
