#include "engine/gltf/node.h"

#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace qtrace::gltf {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

std::vector<std::size_t> find_parents(const Source& source) {
  const std::vector<tinygltf::Node>& nodes = source.model.nodes;
  std::vector<std::size_t> parents(nodes.size(), kNone);
  for (std::size_t parent = 0; parent < nodes.size(); ++parent) {
    for (const int child_index : nodes[parent].children) {
      const auto child = static_cast<std::size_t>(child_index);
      if (parents[child] != kNone) {
        source.fail("{} is a child of {} and again of {}; one parent would be right",
                    node_label(source, child), node_label(source, parents[child]),
                    node_label(source, parent));
      }
      parents[child] = parent;
    }
  }
  return parents;
}

// With at most one parent each, the nodes that no root reaches form cycles.
void check_acyclic(const Source& source, const std::vector<std::size_t>& parents) {
  std::vector<bool> is_reached(parents.size(), false);
  std::vector<std::size_t> pending;
  for (std::size_t node = 0; node < parents.size(); ++node) {
    if (parents[node] == kNone) pending.push_back(node);
  }
  while (!pending.empty()) {
    const std::size_t node = pending.back();
    pending.pop_back();
    is_reached[node] = true;
    for (const int child : source.model.nodes[node].children) {
      pending.push_back(static_cast<std::size_t>(child));
    }
  }
  for (std::size_t node = 0; node < parents.size(); ++node) {
    if (!is_reached[node]) {
      source.fail("{} is its own ancestor; a hierarchy without cycles would be right",
                  node_label(source, node));
    }
  }
}

// Whether one of the ancestors of `node` is in `listed`.
bool comes_with_ancestor(std::size_t node, const std::vector<std::size_t>& parents,
                         const std::set<int>& listed) {
  for (std::size_t up = parents[node]; up != kNone; up = parents[up]) {
    if (listed.contains(static_cast<int>(up))) return true;
  }
  return false;
}

// The index of the scene that is meant; there is one at least.
std::size_t choose_scene(Source& source, const NameOrIndex& wanted) {
  const std::vector<tinygltf::Scene>& scenes = source.model.scenes;
  if (!wanted.is_given()) {
    if (scenes.size() > 1 && source.model.defaultScene < 0) {
      source.warn(
          "the file has {} scenes and says of none that it is the default; the first is read (key "
          "'gltf_scene' "
          "chooses)",
          scenes.size());
    }
    return static_cast<std::size_t>(std::max(source.model.defaultScene, 0));
  }
  std::vector<std::size_t> found;
  std::string there;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    if (wanted.index ? *wanted.index == i : wanted.name == scenes[i].name) found.push_back(i);
    there += (there.empty() ? "" : ", ") + label("scene", i, scenes[i].name);
  }
  source.check(found.size() == 1, "key 'gltf_scene' is {}, but there {}; the file has {}", wanted.text(),
               found.empty() ? "is none of this name or index" : "are several of this name", there);
  return found.front();
}

std::vector<std::size_t> find_roots(Source& source, const std::vector<std::size_t>& parents,
                                    const NameOrIndex& wanted) {
  std::vector<std::size_t> roots;
  if (source.model.scenes.empty()) {
    source.check(!wanted.is_given(),
                 "key 'gltf_scene' is {}, but the file names no scenes; all of its nodes are one",
                 wanted.text());
    for (std::size_t node = 0; node < parents.size(); ++node) {
      if (parents[node] == kNone) roots.push_back(node);
    }
    return roots;
  }
  const std::vector<int>& nodes = source.model.scenes[choose_scene(source, wanted)].nodes;
  const std::set<int> listed(nodes.begin(), nodes.end());
  std::set<int> seen;
  for (const int index : nodes) {
    const auto node = static_cast<std::size_t>(index);
    source.check(seen.insert(index).second, "the scene lists {} twice; once would be right",
                 node_label(source, node));
    if (parents[node] == kNone) {
      roots.push_back(node);
      continue;
    }
    // Without the ancestor it could stand where that puts it or where its own transform does.
    source.check(
        comes_with_ancestor(node, parents, listed),
        "the scene lists {}, but not its parent {}, so that nothing says whether the parent moves it; only "
        "roots would be right",
        node_label(source, node), node_label(source, parents[node]));
    source.warn("the scene lists {} beside an ancestor, which brings it anyway; it is read once",
                node_label(source, node));
  }
  return roots;
}

// So far from 1 the length of a rotation may be by rounding alone, and so far by carelessness: then it is
// still clear what was meant.
constexpr double kRoundedRotation = 1e-3;
constexpr double kCarelessRotation = 0.0101;

glm::dmat4 rotation_matrix(Source& source, std::size_t index) {
  const std::vector<double>& file = source.model.nodes[index].rotation;
  const glm::dquat rotation(file[3], file[0], file[1], file[2]);
  const double length = glm::length(rotation);
  const double error = std::abs(length - 1);
  source.check(error < kCarelessRotation, "{}: the rotation has length {}; a unit quaternion would be right",
               node_label(source, index), length);
  if (error >= kRoundedRotation) {
    source.warn("{}: the rotation has length {} in place of 1; it is normalised", node_label(source, index),
                length);
  }
  return glm::mat4_cast(rotation / length);
}

glm::dmat4 affine(Source& source, std::size_t index, glm::dmat4 matrix) {
  constexpr double kRounding = 1e-5;
  const glm::dvec4 right(0, 0, 0, 1);
  const glm::dvec4 row = glm::row(matrix, 3);
  source.check(glm::all(glm::lessThan(glm::abs(row - right), glm::dvec4(kRounding))),
               "{}: the matrix is not affine; 0 0 0 1 would be right as its last row",
               node_label(source, index));
  if (row == right) return matrix;
  source.warn("{}: the matrix's last row is {} {} {} {}; it is read as 0 0 0 1", node_label(source, index),
              row.x, row.y, row.z, row.w);
  return glm::row(matrix, 3, right);
}

glm::dmat4 local_transform(Source& source, std::size_t index) {
  const tinygltf::Node& node = source.model.nodes[index];
  if (!node.matrix.empty()) {
    return affine(source, index, glm::make_mat4(node.matrix.data()));
  }
  glm::dmat4 transform(1.0);
  if (!node.translation.empty()) {
    transform = glm::translate(transform, glm::make_vec3(node.translation.data()));
  }
  if (!node.rotation.empty()) transform *= rotation_matrix(source, index);
  if (!node.scale.empty()) transform = glm::scale(transform, glm::make_vec3(node.scale.data()));
  return transform;
}

// KHR_node_visibility of the node itself.
bool is_shown(const tinygltf::Node& node) {
  const auto extension = node.extensions.find("KHR_node_visibility");
  return extension == node.extensions.end() || !extension->second.Has("visible") ||
         extension->second.Get("visible").Get<bool>();
}

// Of KHR_lights_punctual; -1: none.
int light_of(const tinygltf::Node& node) {
  const auto extension = node.extensions.find("KHR_lights_punctual");
  return extension == node.extensions.end() ? -1 : extension->second.Get("light").GetNumberAsInt();
}

}  // namespace

bool fits_float(const glm::dmat4& matrix) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      // Written so that NaN fails too.
      if (!(std::abs(matrix[column][row]) <= std::numeric_limits<float>::max())) return false;
    }
  }
  return true;
}

std::string node_label(const Source& source, std::size_t index) {
  return label("node", index, source.model.nodes[index].name);
}

std::vector<PlacedNode> place_nodes(Source& source, const NameOrIndex& scene) {
  const std::vector<std::size_t> parents = find_parents(source);
  check_acyclic(source, parents);
  struct Pending {
    PlacedNode node;
    bool is_shown;
  };
  std::vector<Pending> pending;
  const std::vector<std::size_t> roots = find_roots(source, parents, scene);
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) {
    pending.push_back({{*root, glm::dmat4(1.0)}, true});
  }

  // A stack of our own: a file may nest nodes deeper than the call stack.
  std::vector<PlacedNode> placed;
  while (!pending.empty()) {
    auto [node, shown] = pending.back();
    pending.pop_back();
    node.to_world *= local_transform(source, node.index);  // until here: the parent's
    if (!fits_float(node.to_world)) {
      source.fail("{}: its world transform overflows; smaller translations and scales would be right",
                  node_label(source, node.index));
    }
    const tinygltf::Node& file = source.model.nodes[node.index];
    shown = shown && is_shown(file);
    node.mesh = shown ? file.mesh : -1;
    node.light = shown ? light_of(file) : -1;
    placed.push_back(node);
    for (auto child = file.children.rbegin(); child != file.children.rend(); ++child) {
      pending.push_back({{static_cast<std::size_t>(*child), node.to_world}, shown});
    }
  }
  return placed;
}

}  // namespace qtrace::gltf
