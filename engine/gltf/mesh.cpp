#include "engine/gltf/mesh.h"

#include "engine/gltf/triangle.h"

#include <algorithm>
#include <array>
#include <optional>

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
  void add_primitive(const Primitive& primitive, TrianglePlacer& placer);
  void skip_primitive(const Primitive& primitive, const std::string& place);
  void warn_of_losses(const Losses& losses, const std::string& place);
  void finish(Object object, const std::string& place, bool is_partly_mapped);

  Source& source_;
  Scene& scene_;
  std::optional<std::uint32_t> default_material_;
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

void ObjectBuilder::add_primitive(const Primitive& primitive, TrianglePlacer& placer) {
  const std::uint32_t material = material_index(primitive.material());
  const std::size_t count = primitive.triangle_count();
  for (std::size_t i = 0; i < count; ++i) {
    std::optional<Triangle> triangle = placer.place(primitive, i);
    if (!triangle) continue;
    triangle->material = material;
    triangle->object = static_cast<std::uint32_t>(scene_.objects.size());
    scene_.triangles.push_back(*triangle);
  }
}

void ObjectBuilder::skip_primitive(const Primitive& primitive, const std::string& place) {
  constexpr std::array kNames{"points", "lines", "a line loop", "a line strip"};
  if (static_cast<std::size_t>(primitive.mode()) >= kNames.size()) {
    source_.warn("{}: {} has no POSITION; it is skipped", place, primitive.place());
    return;
  }
  source_.warn("{}: {} holds {}, which are not modelled; it is skipped", place, primitive.place(),
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
}

void ObjectBuilder::finish(Object object, const std::string& place, bool is_partly_mapped) {
  object.triangle_count = static_cast<std::uint32_t>(scene_.triangles.size()) - object.first_triangle;
  if (object.triangle_count == 0) {
    source_.warn("{} has no triangles and is omitted", place);
    return;
  }
  if (is_partly_mapped) {
    source_.warn("{}: only some primitives have TEXCOORD_0, so the object counts as having no UV map", place);
    for (std::size_t i = object.first_triangle; i < scene_.triangles.size(); ++i) scene_.triangles[i].uv = {};
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
    const Primitive primitive = pose.primitive(i);
    if (!primitive.is_surface()) {
      skip_primitive(primitive, place);
      continue;
    }
    (primitive.has_uv() ? some_mapped : some_unmapped) = true;
    add_primitive(primitive, placer);
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
