#include "engine/tracer/frame.h"

#include "engine/gpu/structs.h"
#include "engine/tracer/stratified_points.h"
#include "engine/tracer/tiles.h"

#include <algorithm>

namespace qtrace {
namespace {

// Work groups of one invocation for each light path stand in rows: OpenGL promises 65,535 along a side.
constexpr std::uint32_t kLongestRow = 32768;

}  // namespace

std::vector<gpu::Program*> FrameShaders::all() const {
  std::vector<gpu::Program*> programs;
  for (const auto& program : {trace, trace_light}) {
    if (program) programs.push_back(program.get());
  }
  return programs;
}

void trace_light_paths(const RenderSettings& settings, const FrameShaders& shaders) {
  if (!shaders.trace_light) return;
  const auto paths = static_cast<std::uint32_t>(light_paths_of_a_frame(settings));
  const std::uint32_t groups = (paths + gpu::TRACE_GROUP - 1) / gpu::TRACE_GROUP;
  const std::uint32_t row = std::min(groups, kLongestRow);
  shaders.trace_light->dispatch(row, (groups + row - 1) / row);
}

void render_frame(const Frame& frame, const RenderSettings& settings, const FrameShaders& shaders,
                  Film& film) {
  film.start_frame();
  for (gpu::Program* program : shaders.all()) {
    program->set_frame(frame.number);
    program->set_teaches(frame.teaches);
  }
  if (settings.random == RandomNumbers::sobol) {
    const auto [sequence, index] = frame.place;
    shaders.trace->set_point(sequence,
                             stratified_points(settings.seed, sequence, index, settings.stratified_events));
  }
  trace_light_paths(settings, shaders);
  shaders.trace->dispatch(tiles(settings.width), tiles(settings.height));
  film.accumulate(frame.number, frame.weight, shaders.trace_light != nullptr);
}

}  // namespace qtrace
