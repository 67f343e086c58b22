#include "engine/gltf/mesh.h"

#include "engine/gltf/tangents.h"
#include "engine/gltf/texture.h"
#include "engine/gltf/triangle.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <span>

namespace qtrace::gltf {
namespace {

// Of a mesh; memory and time are spent on each primitive too.
struct Count {
  std::size_t triangles = 0;
  std::size_t primitives = 0;
};

Count count_mesh(const Source& source, std::size_t mesh) {
  Count count;
  count.primitives = source.model.meshes[mesh].primitives.size();
  for (std::size_t i = 0; i < count.primitives; ++i) {
    count.triangles += Primitive(source, mesh, i).triangle_count();
  }
  return count;
}

class ObjectBuilder {
 public:
  ObjectBuilder(Source& source, Scene& scene) : source_(source), scene_(scene) {}

  void add(const PlacedNode& node, const NodeTransforms& transforms);
  float extent() const { return extent_; }

 private:
  std::string object_name(const PlacedNode& node) const;
  std::uint32_t material_index(int index);
  Extras wanted_extras(int material) const;
  void warn_of_missing_uv(const Primitive& primitive, const Material& material);
  void add_primitive(const Primitive& primitive, std::uint32_t material, TrianglePlacer& placer);
  void skip_primitive(const Primitive& primitive, const std::string& place);
  void warn_of_losses(const Losses& losses, const std::string& place);
  void finish(Object object, const std::string& place, bool is_partly_mapped);

  Source& source_;
  Scene& scene_;
  std::optional<std::uint32_t> default_material_;
  std::set<std::string> unmapped_;  // primitives that a warning has named
  float extent_ = 0;
};

std::string ObjectBuilder::object_name(const PlacedNode& node) const {
  const std::string& name = source_.model.nodes[node.index].name;
  if (!name.empty()) return name;
  const std::string& mesh = source_.model.meshes[static_cast<std::size_t>(node.mesh)].name;
  return mesh.empty() ? node_label(source_, node.index) : mesh;
}

std::uint32_t ObjectBuilder::material_index(int index) {
  if (index >= 0) return static_cast<std::uint32_t>(index);
  if (!default_material_) {
    default_material_ = static_cast<std::uint32_t>(scene_.materials.size());
    scene_.materials.emplace_back().name = "default";
  }
  return *default_material_;
}

Extras ObjectBuilder::wanted_extras(int material) const {
  if (material < 0) return {.colors = true};
  const Material& look = scene_.materials[static_cast<std::size_t>(material)];
  return {reads_uv_set(look, 1), normal_texture(look) != nullptr, true};
}

// One mesh may hang on many nodes, and is named once.
void ObjectBuilder::warn_of_missing_uv(const Primitive& primitive, const Material& material) {
  const std::array has{primitive.has_uv(), primitive.has_uv1()};
  for (std::size_t set = 0; set < has.size(); ++set) {
    if (has[set] || !reads_uv_set(material, set)) continue;
    if (!unmapped_.insert(fmt::format("{} {}", primitive.place(), set)).second) continue;
    source_.warn("{} has no TEXCOORD_{}, by which material '{}' reads textures; they are read at (0, 0)",
                 primitive.place(), set, one_line(material.name, 100));
  }
}

void ObjectBuilder::add_primitive(const Primitive& primitive, std::uint32_t material,
                                  TrianglePlacer& placer) {
  const Texture* const normals = normal_texture(scene_.materials[material]);
  const bool need_attributes = normals != nullptr || reads_uv_set(scene_.materials[material], 1);
  const std::size_t first = scene_.triangles.size(), count = primitive.triangle_count();
  for (std::size_t i = 0; i < count; ++i) {
    std::optional<PlacedTriangle> placed = placer.place(primitive, i);
    if (!placed) continue;
    Triangle& triangle = scene_.triangles.emplace_back(placed->triangle);
    triangle.material = material;
    triangle.object = static_cast<std::uint32_t>(scene_.objects.size());
    if (!need_attributes && placed->attributes.color == TriangleAttributes().color) continue;
    triangle.attributes = static_cast<std::uint32_t>(scene_.attributes.size());
    scene_.attributes.push_back(placed->attributes);
  }
  if (normals == nullptr || primitive.has_tangents()) return;
  generate_tangents(std::span(scene_.triangles).subspan(first), normals->uv_set, scene_.attributes);
}

void ObjectBuilder::skip_primitive(const Primitive& primitive, const std::string& place) {
  constexpr std::array kNames{"a set of points", "a set of lines", "a line loop", "a line strip"};
  if (static_cast<std::size_t>(primitive.mode()) >= kNames.size()) {
    source_.warn("{}: {} has no POSITION; it is skipped", place, primitive.place());
    return;
  }
  source_.warn("{}: {} holds {}, which has no surface; it is skipped", place, primitive.place(),
               kNames.at(static_cast<std::size_t>(primitive.mode())));
}

void ObjectBuilder::warn_of_losses(const Losses& losses, const std::string& place) {
  const std::size_t corners = 3 * (losses.triangles - losses.flat_triangles);
  if (losses.flat_triangles > 0) {
    source_.warn("{}: dropped {} of {} triangles for having no area: {}", place, losses.flat_triangles,
                 losses.triangles, losses.flat_names);
  }
  if (losses.zero_normals > 0) {
    source_.warn("{}: took the face's normal at {} of {} corners, where the file's has length zero", place,
                 losses.zero_normals, corners);
  }
  if (losses.opposed_normals > 0) {
    source_.warn("{}: took the face's normal at {} of {} corners, where the file's points behind the face",
                 place, losses.opposed_normals, corners);
  }
  if (losses.odd_colors > 0) {
    source_.warn("{}: the COLOR_0 of {} of {} corners is outside of 0 to 1; it is clamped", place,
                 losses.odd_colors, corners);
  }
}

void ObjectBuilder::finish(Object object, const std::string& place, bool is_partly_mapped) {
  object.triangle_count = static_cast<std::uint32_t>(scene_.triangles.size()) - object.first_triangle;
  if (object.triangle_count == 0) {
    source_.warn("{} has no triangles and is omitted", place);
    return;
  }
  if (is_partly_mapped) {
    source_.warn("{}: only some primitives have TEXCOORD_0, so the object counts as having no UV map", place);
    for (std::size_t i = object.first_triangle; i < scene_.triangles.size(); ++i) {
      Triangle& triangle = scene_.triangles[i];
      if (!reads_uv_set(scene_.materials[triangle.material], 0)) triangle.uv = {};
    }
  }
  scene_.objects.push_back(std::move(object));
}

void ObjectBuilder::add(const PlacedNode& node, const NodeTransforms& transforms) {
  std::string name = object_name(node);
  if (node.instance) name += fmt::format(" instance {}", *node.instance);
  Object object{name, static_cast<std::uint32_t>(scene_.triangles.size()), 0, false};
  const std::string place = label("object", scene_.objects.size(), object.name);
  const Pose pose(source_, node, transforms);
  TrianglePlacer placer(source_, place, pose);
  bool some_mapped = false;
  bool some_unmapped = false;
  for (std::size_t i = 0; i < source_.model.meshes[pose.mesh()].primitives.size(); ++i) {
    const int named = source_.model.meshes[pose.mesh()].primitives[i].material;
    const Primitive primitive = pose.primitive(i, wanted_extras(named));
    if (!primitive.is_surface()) {
      skip_primitive(primitive, place);
      continue;
    }
    (primitive.has_uv() ? some_mapped : some_unmapped) = true;
    const std::uint32_t material = material_index(named);
    warn_of_missing_uv(primitive, scene_.materials[material]);
    add_primitive(primitive, material, placer);
  }
  warn_of_losses(placer.losses(), place);
  extent_ = std::max(extent_, placer.extent());
  object.has_uv = some_mapped && !some_unmapped;
  finish(std::move(object), place, some_mapped && some_unmapped);
}

}  // namespace

std::size_t count_triangles(const Source& source, const std::vector<PlacedNode>& nodes,
                            const SceneLimits& limits) {
  std::vector<std::optional<Count>> counts(source.model.meshes.size());
  Count total;
  for (const PlacedNode& node : nodes) {
    if (node.mesh < 0) continue;
    const auto mesh = static_cast<std::size_t>(node.mesh);
    std::optional<Count>& count = counts[mesh];
    if (!count) count = count_mesh(source, mesh);
    total.triangles += count->triangles;
    total.primitives += count->primitives;
    source.check(total.triangles <= limits.triangles,
                 "the scene has more than {} triangles, which is the most supported", limits.triangles);
    source.check(total.primitives <= limits.primitives,
                 "the nodes' meshes have more than {} primitives, which is the most supported",
                 limits.primitives);
  }
  return total.triangles;
}

float add_objects(Source& source, const std::vector<PlacedNode>& nodes, Scene& scene) {
  ObjectBuilder builder(source, scene);
  const NodeTransforms transforms(source, nodes);
  for (const PlacedNode& node : nodes) {
    if (node.mesh >= 0) builder.add(node, transforms);
  }
  if (scene.triangles.empty()) source.warn("the scene has no triangles; nothing but the environment is seen");
  return builder.extent();
}

}  // namespace qtrace::gltf
