#include "engine/gltf/camera.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/matrix.hpp>

#include <cmath>

namespace qtrace::gltf {
namespace {

// Keeps the viewing direction and, of the up direction, what is perpendicular to it.
glm::mat4 without_scale(const Source& source, const std::string& node, const glm::dmat4& to_world) {
  const glm::dmat3 axes(glm::normalize(glm::dvec3(to_world[0])), glm::normalize(glm::dvec3(to_world[1])),
                        glm::normalize(glm::dvec3(to_world[2])));
  const double volume = glm::determinant(axes);
  // NaN, where an axis has no length, fails the comparison as well.
  source.check(std::abs(volume) > 1e-6,
               "{}: the camera is squeezed flat; a scale other than 0 would be right", node);
  // A pinhole camera cannot show a mirrored image, and to drop the mirroring silently would be wrong.
  source.check(volume > 0, "{}: the camera is mirrored; a positive scale would be right", node);
  const glm::dvec3& back = axes[2];
  const glm::dvec3 right = glm::normalize(glm::cross(axes[1], back));
  const glm::dvec3 up = glm::cross(back, right);
  return glm::mat4(glm::dmat4(glm::dvec4(right, 0), glm::dvec4(up, 0), glm::dvec4(back, 0), to_world[3]));
}

Camera make_camera(const Source& source, const PlacedNode& node) {
  const std::string place = node_label(source, node.index);
  const auto index = static_cast<std::size_t>(source.model.nodes[node.index].camera);
  const tinygltf::Camera& camera = source.model.cameras[index];
  const std::string name = label("camera", index, camera.name);
  source.check(camera.type == "perspective", "{} at {} is {}; a perspective camera would be right", name,
               place, camera.type);
  const auto fov = static_cast<float>(camera.perspective.yfov);
  source.check(fov > 0 && static_cast<double>(fov) < glm::pi<double>(),
               "{} at {}: yfov is {}; an angle between 0 and pi would be right", name, place,
               camera.perspective.yfov);
  return {without_scale(source, place, node.to_world), fov};
}

}  // namespace

Camera read_camera(Source& source, const std::vector<PlacedNode>& nodes) {
  const PlacedNode* first = nullptr;
  for (const PlacedNode& node : nodes) {
    if (source.model.nodes[node.index].camera < 0) continue;
    if (first == nullptr) {
      first = &node;
    } else {
      source.warn("{} holds a further camera, which is ignored; {} is used", node_label(source, node.index),
                  node_label(source, first->index));
    }
  }
  source.check(first != nullptr, "the scene has no camera; add a node with a perspective camera");
  return make_camera(source, *first);
}

}  // namespace qtrace::gltf
