// The events of a frame's light paths, kept on the device for the camera's paths to connect to.
#pragma once

#include "engine/core/settings.h"
#include "engine/gpu/buffer.h"
#include "engine/tracer/film.h"

#include <cstddef>
#include <cstdint>

namespace qtrace {

// Of how many light paths of a frame: of all, as far as 128 MiB have room for as many events as they may
// have.
std::uint32_t kept_light_paths(const RenderSettings& settings);

class LightVertices {
 public:
  explicit LightVertices(const RenderSettings& settings);

  void bind() const { buffer_.bind_storage(gpu::BINDING_LIGHT_VERTICES); }
  // How often an event of the camera is connected to an event of a given light path, on average: one over
  // the mean number of events that are kept of a path. `film`: that of traced light paths.
  float connections(const Film& film) const;
  std::size_t bytes() const { return buffer_.bytes(); }

 private:
  std::uint32_t paths_;
  gpu::Buffer buffer_;
};

}  // namespace qtrace
