#pragma once

#include "engine/gpu/buffer.h"
#include "engine/gpu/shader_source.h"

#include <glm/vec4.hpp>

#include <cstdint>
#include <span>
#include <string>

namespace qtrace::gpu {

// A compute program. Throws Error with the driver's log, files and lines as in shaders/.
class Program {
 public:
  explicit Program(const ShaderSource& source);
  // From shaders/<name>.
  Program(const std::string& name, const Defines& defines);
  ~Program();
  Program(Program&& other) noexcept;
  Program& operator=(Program&& other) noexcept;

  std::uint32_t id() const { return id_; }
  void set_frame(std::uint32_t frame);
  void set_teaches(bool teaches);
  void set_weight(float weight);
  // The frame's sequence of Sobol' points and its point of it, a uvec4 for each block of random words.
  void set_point(std::uint32_t sequence, std::span<const glm::uvec4> words);
  // Work groups; earlier writes to storage buffers are seen.
  void dispatch(std::uint32_t x, std::uint32_t y = 1) const;
  // As many work groups as the buffer's first three words say when the device gets there.
  void dispatch_indirect(const Buffer& size) const;

 private:
  std::uint32_t id_ = 0;
};

}  // namespace qtrace::gpu
