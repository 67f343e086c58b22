// Triangles without what others cover of them.
#pragma once

#include "engine/gltf_document/source.h"
#include "engine/scene/scene.h"

#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace qtrace::gltf {

struct Cut {
  std::uint32_t loser;  // triangles
  std::uint32_t winner;
  auto operator<=>(const Cut&) const = default;
};

// Takes from each loser what its winners cover; pieces no wider than `rounding` are dropped, and objects of
// which nothing is left. Error where more than `max_triangles` would be.
void cut_out(const Source& source, Scene& scene, std::vector<Cut> cuts, double rounding,
             std::size_t max_triangles);

}  // namespace qtrace::gltf
