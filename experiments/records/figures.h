// The numbers of a run: every column of summary.csv that is measured or follows from what is measured.
#pragma once

#include "experiments/files/csv.h"
#include "experiments/files/json.h"
#include "experiments/records/records.h"

#include <string>
#include <vector>

namespace qtrace::experiments {

struct Figure {
  Column<RunRecord> column;
  std::string label;  // for people
  std::string unit;   // "" where it has none
  std::string formula;
  std::string source{};
  bool is_signed = false;    // may be negative: its interval over seeds is symmetric
  bool is_averaged = false;  // over the seeds of a configuration: stands in configurations.csv
  bool is_compared = false;  // with the baseline's: stands in ratios.csv
  bool is_error = false;     // of the image against the reference, and averaged: what curves are drawn of
};

// What shaders count: a column of frames.csv, and of summary.csv over all frames.
struct CounterColumn {
  std::string name;
  std::string label;
  std::string unit;
  CsvValue (*value)(const FrameCounters&);
  bool is_averaged = false;
};
std::vector<CounterColumn> counter_columns();

// In the order of the columns.
const std::vector<Figure>& run_figures();

// For manifests: name, label, unit, formula and source of every figure, whether it may be negative, whether
// it is averaged over seeds, and whether it is an error of the image. What reads results takes its labels
// from there.
Json figures_json();

}  // namespace qtrace::experiments
