// The files about all runs of an experiment, kept up to date while it runs.
#pragma once

#include "engine/gpu/context.h"
#include "experiments/config/experiment_config.h"
#include "experiments/files/json.h"
#include "experiments/records/configurations.h"
#include "experiments/reference/reference_store.h"
#include "experiments/runtime/progress.h"
#include "experiments/runtime/scene_store.h"

#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace qtrace::experiments {

class Journal {
 public:
  Journal(const Experiment& experiment, SceneStore& scenes, const gpu::DeviceInfo& device,
          const ReferenceStore& references, std::filesystem::path folder);

  // A run that ended or was stopped; one of the same place is replaced. Writes the files unless that was done
  // a moment ago: their size grows with the runs, and they must not cost more than a small share of the time.
  void add(RunRecord record);
  // One that an earlier process left; writes nothing.
  void adopt(RunRecord record);
  const RunRecord* find(std::size_t place) const;

  // Writes the files as they are now. Throws Error.
  void write();

  // `stopped`: why the work ends before all is done; empty where it does not. Tells variance and bias of the
  // configurations apart, and writes the files.
  void close(const std::string& stopped, Progress& progress);

  bool all_finished() const;  // and met what was expected of them
  std::string table() const;

 private:
  using Clock = std::chrono::steady_clock;

  std::vector<Configuration> collect() const;
  void separate(Progress& progress);
  Json run_list() const;

  const Experiment& experiment_;
  const ReferenceStore& references_;
  std::string device_;
  std::filesystem::path folder_;
  std::vector<RunRecord> records_;           // in the order of the config
  std::map<std::string, ErrorParts> parts_;  // by configuration
  Json manifest_;
  Clock::time_point written_;
  Clock::duration cost_{};  // of the last writing
};

// Whether it finished and met what was expected of it.
bool met_expectation(const RunRecord& record);

}  // namespace qtrace::experiments
