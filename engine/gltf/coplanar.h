// Which triangles lie in one plane and overlap.
#pragma once

#include "engine/gltf/parts.h"
#include "engine/gltf_document/source.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <vector>

namespace qtrace::gltf {

struct Overlap {
  std::uint32_t a;  // triangles, a < b
  std::uint32_t b;
  double area;
  bool is_opposite;  // they face opposite sides
};

// Those of parts that differ, and of what emits. Two triangles are in one plane where they lie apart by no
// more than `rounding`. Error where there are so many that no memory would hold them.
std::vector<Overlap> find_overlaps(const Source& source, const Scene& scene, const Parts& parts,
                                   float rounding);

}  // namespace qtrace::gltf
