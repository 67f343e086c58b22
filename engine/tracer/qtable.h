// The Q-table on the device: sites, values, and the update between two frames.
#pragma once

#include "engine/core/settings.h"
#include "engine/gpu/buffer.h"
#include "engine/gpu/program.h"
#include "engine/scene/scene.h"
#include "engine/tracer/cell_buffers.h"

#include <cstdint>
#include <span>
#include <vector>

namespace qtrace {

class QTable {
 public:
  // `seed`: of the values of a random initial table.
  QTable(const Scene& scene, const RlSettings& settings, const gpu::Defines& defines, std::uint32_t seed);

  void bind() const;
  // Applies the targets that a frame gathered and prepares the next frame's bins. Parameters must be bound.
  void learn();
  // As at the start: initial values, nothing visited.
  void reset();

  // Entries of a table, before it is built: cells x bins.
  static std::size_t entries(const Scene& scene, const RlSettings& settings);

  const CellBuffers& cells() const { return cells_; }
  std::size_t bytes() const;

  // For studies and tests of the table itself; entry = cell * bins + bin. set_values() keeps the visits.
  std::vector<float> values() const;
  std::vector<std::uint32_t> visits() const;
  void set_values(std::span<const float> values);

 private:
  CellBuffers cells_;
  std::size_t entries_;
  InitialTable initial_table_;
  std::uint32_t seed_;
  gpu::Buffer values_;
  gpu::Buffer visits_;
  gpu::Buffer sums_;
  gpu::Buffer bin_starts_;
  gpu::Buffer next_values_;
  gpu::Program learn_;
};

}  // namespace qtrace
