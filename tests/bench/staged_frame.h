// A frame of the tracer taken apart into its passes, and its tracing shader with one step done twice or left
// out.
#pragma once

#include "engine/core/image.h"
#include "engine/gpu/context.h"
#include "engine/device_scene/scene_buffers.h"
#include "engine/tracer/film.h"
#include "engine/tracer/qtable.h"
#include "tests/bench/timing.h"

#include <array>
#include <string_view>

namespace qtrace::bench {

// The tracing shader: as it is; with every cell looked up twice; with every direction drawn, and every
// density of a given one found, twice; without targets. The second time its input has zeros added that no
// compiler knows of, and both results are needed, so that it is not optimised away; the image stays the same,
// to the bit.
enum class TraceForm { plain, cell_twice, direction_twice, no_targets };
inline constexpr std::array<std::string_view, 4> kTraceForms{"plain", "cells twice", "directions twice",
                                                             "no targets"};

// What a Tracer does for the sampler rl, one pass at a time.
class StagedFrame {
 public:
  StagedFrame(const gpu::Context& context, const Scene& scene, const RenderSettings& settings);

  // None of these waits.
  void trace(TraceForm form);
  void accumulate() { film_.accumulate(frame_, 1, false); }
  void learn() { table_.learn(); }
  void forget() { table_.discard(); }  // what was gathered
  void next_frame() { ++frame_; }

  // The mean of the first frames from the beginning, with tracing in this form.
  RadianceImage image_of(TraceForm form, std::uint32_t frames);

 private:
  void bind() const;

  gpu::SceneBuffers buffers_;
  RenderSettings settings_;  // as they take effect
  gpu::Defines defines_;
  QTable table_;
  Film film_;
  gpu::Buffer parameters_;
  std::array<gpu::Program, kTraceForms.size()> trace_;
  std::uint32_t frame_ = 1;
};

// Throws Error unless the frame taken apart renders the tracer's image, to the bit, in every form; without
// targets there is only one frame before the table would differ.
void check_same_image(const gpu::Context& context, const Scene& scene, const RenderSettings& settings,
                      StagedFrame& staged);

}  // namespace qtrace::bench
