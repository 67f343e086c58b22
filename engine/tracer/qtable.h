// The table on the device: cells, values, and the update between two frames.
#pragma once

#include "engine/core/settings.h"
#include "engine/gpu/buffer.h"
#include "engine/gpu/program_cache.h"
#include "engine/scene/scene.h"
#include "engine/tracer/cell_buffers.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace qtrace {

class QTable {
 public:
  // `actions`: of a state (table_actions() of shader_variant.h).
  QTable(const Scene& scene, const RlSettings& settings, std::size_t actions, const gpu::Defines& defines,
         gpu::ProgramCache& programs);

  void bind() const;
  // Applies the targets that a frame gathered and prepares what the next one draws from. Parameters must be
  // bound.
  void learn();
  // Forgets what was gathered and not yet applied.
  void discard();
  // As at the start: initial values, nothing visited. Parameters must be bound.
  void reset();

  // What has been learned, and what the next frame draws from; between frames there is no more.
  std::vector<gpu::Buffer*> learned();

  const CellBuffers& cells() const { return cells_; }
  std::size_t bytes() const;

  // Throws Error where the device cannot hold such a table.
  static void check_size(std::size_t cells, std::size_t actions);

  std::size_t actions() const { return actions_; }

  // For studies and tests of the table itself; entry = cell * actions + action, direction bins before lights
  // (shaders/learning/table.glsl). set_values() keeps the visits.
  std::vector<float> values() const;
  std::vector<std::uint32_t> visits() const;
  void set_values(std::span<const float> values);

 private:
  void apply();        // to the cells that are listed
  void prepare_all();  // as if targets had been gathered for every cell
  void forget_touched();

  CellBuffers cells_;
  std::size_t actions_;
  std::size_t entries_;
  gpu::Buffer values_;
  gpu::Buffer visits_;
  gpu::Buffer sums_;  // and marks of the cells that have any
  gpu::Buffer starts_;
  gpu::Buffer next_values_;
  gpu::Buffer bsdf_shares_;
  gpu::Buffer touched_;
  gpu::Buffer places_;
  std::shared_ptr<gpu::Program> initialize_;
  std::shared_ptr<gpu::Program> list_;
  std::shared_ptr<gpu::Program> learn_;
};

}  // namespace qtrace
