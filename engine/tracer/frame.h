// One frame: a sample for every pixel of a film, and its sums.
#pragma once

#include "engine/core/settings.h"
#include "engine/gpu/program.h"
#include "engine/tracer/film.h"
#include "engine/tracer/sample_sequence.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace qtrace {

struct Frame {
  std::uint32_t number = 0;  // from 1
  SequencePlace place;       // of its points, with Sobol' points
  bool teaches = false;
  float weight = 1;
};

// What renders it: one kind of frames, with the table or without it.
struct FrameShaders {
  std::shared_ptr<gpu::Program> trace;
  std::shared_ptr<gpu::Program> trace_light;  // null where no paths start at lights

  std::vector<gpu::Program*> all() const;
};

// Enqueues those of a frame that is set; with HAS_CONNECTIONS, the camera's paths need them.
void trace_light_paths(const RenderSettings& settings, const FrameShaders& shaders);

// Enqueues it. All that the shader reads must be bound, the film and the parameters of its size among it.
void render_frame(const Frame& frame, const RenderSettings& settings, const FrameShaders& shaders,
                  Film& film);

}  // namespace qtrace
