#pragma once

#include "engine/accel/bvh.h"
#include "engine/device_scene/wide_nodes.h"
#include "engine/gpu/buffer.h"

#include <glm/vec3.hpp>

namespace qtrace::gpu {

// A hierarchy on the device, in the layout of the shaders that walk its kind (define BVH).
class NodeBuffers {
 public:
  // `eye`: see pack_wide_nodes.
  NodeBuffers(const Bvh& bvh, const glm::vec3& eye);

  void bind() const;
  std::size_t bytes() const { return nodes_.bytes() + grid_.bytes(); }

 private:
  NodeBuffers(const Bvh& bvh, const WideNodes& wide);

  Buffer nodes_;
  Buffer grid_;  // of wide nodes
};

}  // namespace qtrace::gpu
