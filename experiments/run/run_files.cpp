#include "experiments/run/run_files.h"

#include "experiments/files/atomic_file.h"
#include "experiments/images/exr_images.h"
#include "experiments/records/columns.h"
#include "experiments/run/saved_table.h"
#include "experiments/runtime/manifest.h"

namespace qtrace::experiments {

std::filesystem::path snapshot_file(const std::filesystem::path& folder, int frame) {
  return folder / fmt::format("frame_{:06}.exr", frame);
}

namespace {

void put_exr(FileQueue& files, const std::filesystem::path& file, ExrImage image) {
  std::size_t bytes = 0;
  for (const auto& [name, plane] : image.channels) bytes += plane.size() * sizeof(float);
  files.put(file, bytes, [exr = std::move(image)](const std::filesystem::path& temporary) {
    write_exr_planes(temporary, exr);
  });
}

}  // namespace

RunFiles::RunFiles(std::filesystem::path folder, ExrMetadata metadata, FileQueue& files)
    : folder_(std::move(folder)), metadata_(std::move(metadata)), files_(files) {
  make_folder(folder_);
}

void RunFiles::write_first_hit(const FirstHitImage& image) const {
  put_exr(files_, folder_ / "first_hit.exr", to_exr(image, metadata_));
}

void RunFiles::write_snapshot(int frame, const RadianceImage& image, const RadianceImage* filtered) const {
  ExrImage exr = to_exr(image, metadata_);
  if (filtered != nullptr) add_filtered(exr, *filtered);
  put_exr(files_, snapshot_file(folder_, frame), std::move(exr));
}

void RunFiles::write_cells(const QTable& table, const glm::dvec3& origin) const {
  experiments::write_cells(files_, folder_, table.cells().states(), origin);
}

void RunFiles::write_q_table(int frame, const QTable& table) const {
  experiments::write_table(files_, folder_, frame, table);
}

void RunFiles::write_tables(const RunRecord& record) const {
  put("frames.csv", csv_text(frame_columns(), record.frames));
  put("convergence.csv", csv_text(snapshot_columns(), record.snapshots));
  if (record.run.config.filter.kind != FilterKind::none) {
    put("convergence_filtered.csv", csv_text(filtered_columns(), record.snapshots));
  }
}

void RunFiles::write_manifest(const Json& manifest) const { put("manifest.json", json_text(manifest)); }

void RunFiles::put(const char* name, std::string content) const {
  files_.put(folder_ / name, std::move(content));
}

}  // namespace qtrace::experiments
