// `qtrace status`: how far the experiments in a results folder are.
#pragma once

#include "experiments/json.h"

#include <filesystem>
#include <string>

namespace qtrace::experiments {

// What a process at work tells of itself, in .progress.json or, of a shard, .progress-2-of-4.json.
inline constexpr const char* kReportName = ".progress";
struct ProgressReport {
  std::string label;  // of the run or reference
  int frame = 0;
  int frames = 0;
  double relmse = -1;  // below 0: not known yet
  double stage_left_s = 0;
  double all_left_s = 0;
};

Json to_json(const ProgressReport& report);

// `folder`: results/<experiment>, or results with several of them. Throws Error where there are none.
std::string status_text(const std::filesystem::path& folder);

}  // namespace qtrace::experiments
