// The one list of columns of each CSV file.
#pragma once

#include "experiments/files/csv.h"
#include "experiments/records/configurations.h"
#include "experiments/records/ratios.h"
#include "experiments/records/records.h"

#include <vector>

namespace qtrace::experiments {

std::vector<Column<FrameRecord>> frame_columns();                           // frames.csv
std::vector<Column<SnapshotRecord>> snapshot_columns();                     // convergence.csv
std::vector<Column<SnapshotRecord>> filtered_columns();                     // convergence_filtered.csv
std::vector<Column<RunRecord>> run_columns(const std::vector<Axis>& axes);  // summary.csv
// configurations.csv: seeds, then mean, _sd, _low and _high of every figure that is averaged.
std::vector<Column<Configuration>> configuration_columns(const std::vector<Axis>& axes);
std::vector<Column<Ratios>> ratio_columns();  // ratios.csv

}  // namespace qtrace::experiments
