// A small picture of the scene, rendered before the first frame, which counts nowhere but in the table and in
// its trial.
#pragma once

#include "engine/core/settings.h"
#include "engine/device_scene/scene_buffers.h"
#include "engine/gpu/program.h"
#include "engine/gpu/program_cache.h"
#include "engine/scene/scene.h"
#include "engine/tracer/cell_buffers.h"
#include "engine/tracer/film.h"
#include "engine/tracer/table_trial.h"

#include <functional>

namespace qtrace {

class Pilot {
 public:
  // Half as wide and as high as the image, or less. `settings` as they take effect.
  Pilot(const Camera& camera, const RenderSettings& settings, const gpu::SceneFeatures& features,
        const CellBuffers* cells, gpu::ProgramCache& programs);

  struct Shaders {
    gpu::Program& with_table;
    gpu::Program& without;
  };
  // All its frames. What the image's frames need must be bound, and has to be bound again. `teaches`: whether
  // its lessons do; `learn` then updates the table after each. Waits for the work.
  TableTrial::PilotLook render(const Shaders& shaders, const TableTrial& trial, bool teaches,
                               const std::function<void()>& learn);

  // Over all its frames; paths, rays and the others as the image's frames count them.
  const FrameCounters& counters() const { return counters_; }

  std::size_t bytes() const { return film_.bytes() + parameter_block_.bytes(); }

 private:
  RenderSettings settings_;
  Film film_;
  gpu::Buffer parameter_block_;
  FrameCounters counters_;
};

}  // namespace qtrace
