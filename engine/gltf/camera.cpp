#include "engine/gltf/camera.h"

#include "engine/scene/cameras.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

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

// What glTF says of a camera beside where it stands.
struct Lens {
  float vertical_fov = 1;
  float film_height = 0;
  double aspect = 0;  // 0: not said
  double near = 0;
  double far = std::numeric_limits<double>::infinity();
};

Lens read_lens(const Source& source, const tinygltf::Camera& camera, const std::string& place) {
  Lens lens;
  if (camera.type == "perspective") {
    const tinygltf::PerspectiveCamera& file = camera.perspective;
    lens.vertical_fov = static_cast<float>(file.yfov);
    source.check(lens.vertical_fov > 0 && static_cast<double>(lens.vertical_fov) < glm::pi<double>(),
                 "{}: yfov is {}; an angle between 0 and pi would be right", place, file.yfov);
    lens.aspect = file.aspectRatio;
    lens.near = file.znear;
    if (file.zfar > 0) lens.far = file.zfar;
    return lens;
  }
  const tinygltf::OrthographicCamera& file = camera.orthographic;
  lens.film_height = 2 * static_cast<float>(file.ymag);
  source.check(lens.film_height > 0 && file.xmag > 0 && std::isfinite(lens.film_height),
               "{}: xmag and ymag are {} and {}; both above 0 would be right", place, file.xmag, file.ymag);
  lens.aspect = file.xmag / file.ymag;
  lens.near = file.znear;
  lens.far = file.zfar;
  return lens;
}

struct FileCamera {
  const PlacedNode* node = nullptr;
  std::size_t index = 0;  // into Model::cameras
};

std::string camera_place(const Source& source, const FileCamera& camera) {
  return fmt::format("{} at {}", label("camera", camera.index, source.model.cameras[camera.index].name),
                     node_label(source, camera.node->index));
}

std::vector<FileCamera> cameras_of(const Source& source, const std::vector<PlacedNode>& nodes) {
  std::vector<FileCamera> cameras;
  for (const PlacedNode& node : nodes) {
    const int index = source.model.nodes[node.index].camera;
    if (index >= 0 && !node.instance) cameras.push_back({&node, static_cast<std::size_t>(index)});
  }
  return cameras;
}

// Those that `wanted` may mean: of a name, nodes count before cameras.
std::vector<FileCamera> matching(const Source& source, const std::vector<FileCamera>& cameras,
                                 const NameOrIndex& wanted) {
  const auto those = [&](auto is_meant) {
    std::vector<FileCamera> found;
    std::ranges::copy_if(cameras, std::back_inserter(found), is_meant);
    return found;
  };
  if (wanted.index) return those([&](const FileCamera& camera) { return camera.index == *wanted.index; });
  // A node without a name goes by what messages call it, as "node 3".
  const auto nodes = those([&](const FileCamera& camera) {
    const std::string& name = source.model.nodes[camera.node->index].name;
    return (name.empty() ? node_label(source, camera.node->index) : name) == wanted.name;
  });
  if (!nodes.empty()) return nodes;
  return those(
      [&](const FileCamera& camera) { return source.model.cameras[camera.index].name == wanted.name; });
}

std::string listed(const Source& source, const std::vector<FileCamera>& cameras) {
  constexpr std::size_t kMostNamed = 10;
  std::string text;
  for (std::size_t i = 0; i < cameras.size() && i < kMostNamed; ++i) {
    text += (i == 0 ? "" : ", ") + camera_place(source, cameras[i]);
  }
  if (cameras.size() > kMostNamed) text += fmt::format(" and {} more", cameras.size() - kMostNamed);
  return text;
}

std::string vector_text(const std::array<double, 3>& v) {
  return fmt::format("[{:.4g}, {:.4g}, {:.4g}]", v[0], v[1], v[2]);
}

FileCamera choose_camera(Source& source, const std::vector<PlacedNode>& nodes, const View& view,
                         const Scene& scene) {
  const std::vector<FileCamera> cameras = cameras_of(source, nodes);
  const NameOrIndex& wanted = view.camera.of_file;
  if (cameras.empty()) {
    const CameraPlace fit = fitting_place(scene.triangles, scene.origin, view.aspect);
    source.fail(
        "the scene has no camera; key 'camera' says where one stands: \"fit\" shows everything, as "
        "{{\"position\": {}, \"target\": {}, \"fov\": {}}} does here",
        vector_text(fit.position), vector_text(fit.target), fit.vertical_fov);
  }
  if (!wanted.is_given()) {
    for (std::size_t i = 1; i < cameras.size(); ++i) {
      source.warn("{} holds a further camera, which is ignored; {} is used",
                  node_label(source, cameras[i].node->index), node_label(source, cameras[0].node->index));
    }
    return cameras.front();
  }
  const std::vector<FileCamera> found = matching(source, cameras, wanted);
  source.check(!found.empty(), "key 'camera' is {}, which no camera of the scene is called; there are {}",
               wanted.text(), listed(source, cameras));
  source.check(found.size() == 1, "key 'camera' is {}, which may be {}; the name of a node would be right",
               wanted.text(), listed(source, found));
  return found.front();
}

// More than this, as a factor, tells one aspect ratio from another.
constexpr double kSameAspect = 1.01;

void warn_of_losses(Source& source, const std::string& place, const Lens& lens, const View& view,
                    const Scene& scene) {
  if (lens.aspect > 0 && std::max(lens.aspect / view.aspect, view.aspect / lens.aspect) > kSameAspect) {
    source.warn(
        "{}: its aspectRatio is {:.4g} and the picture's is {:.4g}; the height of what is seen stays, the "
        "width "
        "does not",
        place, lens.aspect, view.aspect);
  }
  if (lens.near > 0 && shows_at_depth(scene, view.aspect, 0, lens.near)) {
    source.warn(
        "{}: something in the picture is nearer than its znear of {:g}, which is not modelled: it is seen "
        "all the same",
        place, lens.near);
  }
  if (std::isfinite(lens.far) &&
      shows_at_depth(scene, view.aspect, lens.far, std::numeric_limits<double>::infinity())) {
    source.warn(
        "{}: something in the picture is farther than its zfar of {:g}, which is not modelled: it is seen "
        "all the same",
        place, lens.far);
  }
}

}  // namespace

void add_camera(Source& source, const std::vector<PlacedNode>& nodes, const View& view, Scene& scene) {
  using Kind = CameraChoice::Kind;
  if (view.camera.kind != Kind::of_file) {
    const bool fits = view.camera.kind == Kind::fit;
    try {
      scene.camera = placed_camera(
          fits ? fitting_place(scene.triangles, scene.origin, view.aspect) : view.camera.place, scene.origin);
    } catch (const Error& error) {
      source.fail("key 'camera': {}", error.what());
    }
    return;
  }
  const FileCamera chosen = choose_camera(source, nodes, view, scene);
  const std::string place = camera_place(source, chosen);
  const Lens lens = read_lens(source, source.model.cameras[chosen.index], place);
  scene.camera = {without_scale(source, node_label(source, chosen.node->index), chosen.node->to_world),
                  lens.vertical_fov, lens.film_height};
  warn_of_losses(source, place, lens, view, scene);
}

}  // namespace qtrace::gltf
