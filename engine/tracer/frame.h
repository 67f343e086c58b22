// One frame: a sample for every pixel of a film, and its sums.
#pragma once

#include "engine/core/settings.h"
#include "engine/gpu/program.h"
#include "engine/tracer/film.h"
#include "engine/tracer/sample_sequence.h"

#include <cstdint>

namespace qtrace {

struct Frame {
  std::uint32_t number = 0;  // from 1
  SequencePlace place;       // of its points, with Sobol' points
  bool teaches = false;
  float weight = 1;
};

// Enqueues it. All that the shader reads must be bound, the film and the parameters of its size among it.
void render_frame(const Frame& frame, const RenderSettings& settings, gpu::Program& shader, Film& film);

}  // namespace qtrace
