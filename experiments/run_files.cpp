#include "experiments/run_files.h"

#include "experiments/atomic_file.h"
#include "experiments/manifest.h"
#include "experiments/saved_table.h"

namespace qtrace::experiments {

std::filesystem::path snapshot_file(const std::filesystem::path& folder, int frame) {
  return folder / fmt::format("frame_{:06}.exr", frame);
}

RunFiles::RunFiles(std::filesystem::path folder, ExrMetadata metadata)
    : folder_(std::move(folder)), metadata_(std::move(metadata)) {
  make_folder(folder_);
}

void RunFiles::write_first_hit(const FirstHitImage& image) const {
  write_exr(folder_ / "first_hit.exr", to_exr(image, metadata_));
}

void RunFiles::write_snapshot(int frame, const RadianceImage& image, const RadianceImage* filtered) const {
  ExrImage exr = to_exr(image, metadata_);
  if (filtered != nullptr) add_filtered(exr, *filtered);
  write_exr(snapshot_file(folder_, frame), exr);
}

void RunFiles::write_cells(const QTable& table, const glm::dvec3& origin) const {
  experiments::write_cells(folder_, table.cells().states(), origin);
}

void RunFiles::write_q_table(int frame, const QTable& table) const {
  experiments::write_table(folder_, frame, table);
}

void RunFiles::write_tables(const RunRecord& record) const {
  write_file(folder_ / "frames.csv", csv_text(frame_columns(), record.frames));
  write_file(folder_ / "convergence.csv", csv_text(snapshot_columns(), record.snapshots));
  if (record.run.config.filter.kind != FilterKind::none) {
    write_file(folder_ / "convergence_filtered.csv", csv_text(filtered_columns(), record.snapshots));
  }
}

void RunFiles::write_manifest(const Json& manifest) const { write_json(folder_ / "manifest.json", manifest); }

}  // namespace qtrace::experiments
