// The device's ray queries, one ray an invocation.
#pragma once

#include "engine/gpu/buffer.h"
#include "engine/gpu/program.h"
#include "tests/bench/rays.h"

#include <string>
#include <vector>

namespace qtrace::bench {

// Rays on the device, and room for their answers.
class RayBuffers {
 public:
  explicit RayBuffers(const std::vector<BenchRay>& rays);

  void bind() const;
  std::uint32_t groups() const;
  // Throws Error where the driver cut a loop of the shader short.
  std::vector<Answer> answers() const;

 private:
  std::size_t count_;
  gpu::Buffer rays_;
  gpu::Buffer answers_;
};

// closest_hit() or is_occluded() of shaders/geometry/traverse.glsl, with further defines.
class RayShader {
 public:
  RayShader(bool occlusion, gpu::Defines defines);

  // Does not wait. What is traced in must be bound.
  void trace(const RayBuffers& rays) const;

 private:
  gpu::Program program_;
};

}  // namespace qtrace::bench
