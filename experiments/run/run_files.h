// The files of one run's folder.
#pragma once

#include "engine/tracer/qtable.h"
#include "experiments/files/file_queue.h"
#include "experiments/files/json.h"
#include "experiments/images/exr.h"
#include "experiments/records/records.h"

#include <filesystem>

namespace qtrace::experiments {

// frame_000064.exr
std::filesystem::path snapshot_file(const std::filesystem::path& folder, int frame);

class RunFiles {
 public:
  // Makes the folder. `metadata` goes into every image. All is written by the queue, which must live longer.
  RunFiles(std::filesystem::path folder, ExrMetadata metadata, FileQueue& files);
  virtual ~RunFiles() = default;
  RunFiles(const RunFiles&) = delete;
  RunFiles& operator=(const RunFiles&) = delete;

  void write_first_hit(const FirstHitImage& image) const;  // first_hit.exr
  // `filtered` may be null.
  virtual void write_snapshot(int frame, const RadianceImage& image, const RadianceImage* filtered) const;
  // frames.csv, convergence.csv and, of a run with a filter, convergence_filtered.csv.
  void write_tables(const RunRecord& record) const;
  void write_cells(const QTable& table, const glm::dvec3& origin) const;  // cells.npy
  void write_q_table(int frame, const QTable& table) const;               // see saved_table.h
  void write_manifest(const Json& manifest) const;                        // manifest.json

 private:
  std::filesystem::path folder_;
  void put(const char* name, std::string content) const;

  ExrMetadata metadata_;
  FileQueue& files_;
};

}  // namespace qtrace::experiments
