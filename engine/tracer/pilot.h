// A small picture of the scene, rendered before the first frame, which counts nowhere but in the table and in
// its trial.
#pragma once

#include "engine/core/settings.h"
#include "engine/device_scene/scene_buffers.h"
#include "engine/gpu/program_cache.h"
#include "engine/scene/scene.h"
#include "engine/tracer/cell_buffers.h"
#include "engine/tracer/film.h"
#include "engine/tracer/frame.h"
#include "engine/tracer/trial.h"

#include <glm/vec2.hpp>

#include <functional>
#include <vector>

namespace qtrace {

class Pilot {
 public:
  // Half as wide and as high as the image (rounded, and one pixel at least), or less. `settings` as they take
  // effect.
  Pilot(const Camera& camera, const RenderSettings& settings, const gpu::SceneFeatures& features,
        const CellBuffers* cells, gpu::ProgramCache& programs);

  // As in the parameters of the image.
  void set_connections(float connections);

  struct Shaders {
    const FrameShaders& with;  // what is tried
    const FrameShaders& without;
  };
  // Its frames, until the trial is decided. What the image's frames need must be bound, and has to be bound
  // again. `teaches`: whether its lessons do; `learn` then updates the table. Waits for the work. There may
  // be a pilot for each of several trials.
  void render(const Shaders& shaders, Trial& trial, bool teaches, const std::function<void()>& learn);

  // Over the frames of all trials; paths, rays and the others as the image's frames count them.
  const FrameCounters& counters() const { return counters_; }
  // Where they lie in the image, with frame 0.
  const std::vector<NonFiniteSample>& non_finite_samples() const { return non_finite_samples_; }

  std::size_t bytes() const { return film_.bytes() + parameter_block_.bytes(); }

 private:
  void note_non_finite();

  RenderSettings settings_;
  glm::uvec2 image_size_;      // pixels
  std::uint32_t most_taught_;  // lessons between two updates, at most
  Film film_;
  gpu::Buffer parameter_block_;
  FrameCounters counters_;
  std::vector<NonFiniteSample> non_finite_samples_;
};

}  // namespace qtrace
