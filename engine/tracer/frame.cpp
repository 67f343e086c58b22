#include "engine/tracer/frame.h"

#include "engine/tracer/stratified_points.h"
#include "engine/tracer/tiles.h"

namespace qtrace {

void render_frame(const Frame& frame, const RenderSettings& settings, gpu::Program& shader, Film& film) {
  film.start_frame();
  shader.set_frame(frame.number);
  shader.set_teaches(frame.teaches);
  if (settings.random == RandomNumbers::sobol) {
    const auto [sequence, index] = frame.place;
    shader.set_point(sequence, stratified_points(settings.seed, sequence, index, settings.stratified_events));
  }
  shader.dispatch(tiles(settings.width), tiles(settings.height));
  film.accumulate(frame.number, frame.weight);
}

}  // namespace qtrace
