// The table of a run as files in its folder.
#pragma once

#include "engine/tracer/qtable.h"
#include "experiments/files/file_queue.h"
#include "experiments/files/npy.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace qtrace::experiments {

// cells.npy: a row per cell with position x, y, z, normal x, y, z and object (-1: several).
void write_cells(FileQueue& files, const std::filesystem::path& folder, const std::vector<CellState>& states,
                 const glm::dvec3& origin);

// q_values_000064.npy and q_visits_000064.npy: a row per cell with a column per direction bin, then one per
// learned light (shaders/learning/table.glsl).
void write_table(FileQueue& files, const std::filesystem::path& folder, int frame, const QTable& table);

struct SavedTable {
  int frame = 0;
  NpyTable<float> values;
  NpyTable<std::uint32_t> visits;
};

// That of `frame`, or the last one. Throws Error: none was saved, not of this frame, or the files do not fit.
SavedTable read_saved_table(const std::filesystem::path& folder, std::optional<int> frame);

}  // namespace qtrace::experiments
