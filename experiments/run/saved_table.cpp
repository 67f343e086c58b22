#include "experiments/run/saved_table.h"

#include "engine/core/check.h"

#include <fmt/ranges.h>

#include <charconv>
#include <set>
#include <string>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kValues = "q_values_";
constexpr std::string_view kVisits = "q_visits_";
constexpr std::size_t kCellColumns = 7;

fs::path table_file(const fs::path& folder, std::string_view kind, int frame) {
  return folder / fmt::format("{}{:06}.npy", kind, frame);
}

// Frames whose values are there.
std::set<int> saved_frames(const fs::path& folder) {
  std::set<int> frames;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    int frame = 0;
    if (!name.starts_with(kValues)) continue;
    std::from_chars(name.data() + kValues.size(), name.data() + name.size(), frame);
    if (table_file(folder, kValues, frame) == entry.path()) frames.insert(frame);
  }
  return frames;
}

}  // namespace

void write_cells(FileQueue& files, const fs::path& folder, const std::vector<CellState>& states,
                 const glm::dvec3& origin) {
  std::vector<float> rows;
  rows.reserve(states.size() * kCellColumns);
  for (const CellState& s : states) {
    const glm::vec3 p(glm::dvec3(s.position) + origin);
    rows.insert(rows.end(), {p.x, p.y, p.z, s.normal.x, s.normal.y, s.normal.z,
                             s.object == kNoObject ? -1.0F : static_cast<float>(s.object)});
  }
  files.put(folder / "cells.npy", npy_text<float>(kCellColumns, rows));
}

void write_table(FileQueue& files, const fs::path& folder, int frame, const QTable& table) {
  files.put(table_file(folder, kValues, frame), npy_text<float>(table.actions(), table.values()));
  files.put(table_file(folder, kVisits, frame), npy_text<std::uint32_t>(table.actions(), table.visits()));
}

SavedTable read_saved_table(const fs::path& folder, std::optional<int> frame) {
  const std::set<int> frames = saved_frames(folder);
  check(!frames.empty(),
        "{}: this run has saved no table; set save_table to last or snapshots in its config and run it again",
        folder.string());
  SavedTable table;
  table.frame = frame.value_or(*frames.rbegin());
  check(frames.contains(table.frame), "{}: no table of frame {} was saved; there are those of {}",
        folder.string(), table.frame, fmt::join(frames, ", "));
  table.values = read_npy<float>(table_file(folder, kValues, table.frame));
  const fs::path visits = table_file(folder, kVisits, table.frame);
  table.visits = read_npy<std::uint32_t>(visits);
  check(table.visits.rows == table.values.rows && table.visits.columns == table.values.columns,
        "{}: is {} x {}, but the values of the same frame are {} x {}", visits.string(), table.visits.rows,
        table.visits.columns, table.values.rows, table.values.columns);
  return table;
}

}  // namespace qtrace::experiments
