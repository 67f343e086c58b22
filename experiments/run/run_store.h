// What is kept of a run besides its results, so that it can be gone on with or need not be done again.
#pragma once

#include "engine/core/check.h"
#include "engine/tracer/tracer_state.h"
#include "experiments/files/file_queue.h"
#include "experiments/records/records.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace qtrace::experiments {

struct Checkpoint {
  RunRecord record;  // as unpack() fills it
  TracerState state;
};

// The files of one run's folder that belong to an identity (run_inputs.h); what belongs to another is not
// seen.
class RunStore {
 public:
  using Complaint = std::function<void(const Error&)>;  // of files that are damaged

  RunStore(std::filesystem::path folder, std::string identity)
      : folder_(std::move(folder)), identity_(std::move(identity)) {}

  void write_checkpoint(FileQueue& files, const RunRecord& record,
                        TracerState state) const;  // checkpoint.state
  std::optional<Checkpoint> read_checkpoint(const Complaint& complain) const;
  void remove_checkpoint(FileQueue& files) const;

  // record.state: of a run that ended, whatever its status.
  void write_record(FileQueue& files, const RunRecord& record) const;
  // Nothing unless the manifest says that the run ended. `run`: what is not in the file.
  std::optional<RunRecord> read_record(const Run& run, const Complaint& complain) const;

 private:
  std::filesystem::path folder_;
  std::string identity_;
};

}  // namespace qtrace::experiments
