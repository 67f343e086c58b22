#include "engine/tracer/light_vertices.h"

#include "engine/gpu/structs.h"

#include <algorithm>

namespace qtrace {
namespace {

// What OpenGL 4.5 promises of a storage buffer (MAX_SHADER_STORAGE_BLOCK_SIZE).
constexpr std::size_t kMostBytes = std::size_t{1} << 27;

// The last event of the longest path is connected to nothing.
std::size_t events_of_a_path(const RenderSettings& settings) {
  return static_cast<std::size_t>(settings.max_bounces) - 1;
}

}  // namespace

std::uint32_t kept_light_paths(const RenderSettings& settings) {
  if (settings.light_paths != LightPaths::connect) return 0;
  const std::size_t most = kMostBytes / sizeof(gpu::LightVertex) / events_of_a_path(settings);
  return static_cast<std::uint32_t>(
      std::min(static_cast<std::size_t>(light_paths_of_a_frame(settings)), most));
}

LightVertices::LightVertices(const RenderSettings& settings)
    : paths_(kept_light_paths(settings)),
      buffer_("events of light paths", paths_ * events_of_a_path(settings) * sizeof(gpu::LightVertex)) {}

float LightVertices::connections(const Film& film) const {
  const double events = film.kept_events(paths_);
  return events > 0 ? static_cast<float>(paths_ / events) : 1.0F;
}

}  // namespace qtrace
