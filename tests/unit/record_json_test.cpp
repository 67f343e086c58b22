#include "experiments/records/record_json.h"

#include "engine/core/check.h"
#include "experiments/records/columns.h"

#include <gtest/gtest.h>

#include <limits>

namespace qtrace::experiments {
namespace {

RunRecord full_record() {
  RunRecord record;
  record.scene = "scene";
  record.status = RunStatus::finished;
  record.reason = "a \"reason\"";
  record.started = "2026-01-01T00:00:00Z";
  record.reference_hash = "r";
  record.config_hash = "c";
  record.setup_s = 0.1;
  for (int i = 1; i <= 3; ++i) {
    FrameRecord frame{i, i == 1, i / 3.0, i / 7.0, i / 11.0, i / 13.0, {}};
    frame.counters.paths = (std::uint64_t{1} << 63U) + static_cast<std::uint64_t>(i);
    frame.counters.clamped_samples = 5;
    record.frames.push_back(frame);
  }
  SnapshotRecord snapshot;
  snapshot.frame = 2;
  snapshot.errors.mse = 1.0 / 3;
  snapshot.errors.psnr_db = std::numeric_limits<double>::infinity();
  snapshot.errors.flip = 0.25;
  snapshot.errors.reference = ReferenceNoise{1e-9, 2e-9};
  record.snapshots.push_back(snapshot);
  snapshot.errors.flip.reset();
  snapshot.errors.relmse = std::numeric_limits<double>::quiet_NaN();
  snapshot.filtered = FilteredRecord{snapshot.errors, 4.5};
  record.snapshots.push_back(snapshot);
  record.fireflies.brightest = 1e30;
  record.verdict = Verdict{"fail", "why", 1, 2, 3, std::numeric_limits<double>::infinity()};
  return record;
}

// By every column of every file: what no file shows need not come back.
std::string texts(const RunRecord& record) {
  return csv_text(frame_columns(), record.frames) + csv_text(snapshot_columns(), record.snapshots) +
         csv_text(filtered_columns(), record.snapshots) + csv_text(run_columns({}), std::vector{record});
}

TEST(RecordJson, ComesBackFromCborWithEveryDigit) {
  const RunRecord record = full_record();
  std::vector<std::uint8_t> bytes;
  Json::to_cbor(pack(record), bytes);
  RunRecord back;
  unpack(Json::from_cbor(bytes), back);
  EXPECT_EQ(texts(record), texts(back));
  EXPECT_EQ(back.frames[2].counters.paths, record.frames[2].counters.paths);
  EXPECT_FALSE(back.snapshots[0].filtered.has_value());
}

TEST(RecordJson, AnotherLayoutIsRefused) {
  Json json = pack(full_record());
  json["layout"] = 99;
  RunRecord record;
  EXPECT_THROW(unpack(json, record), Error);
  json = pack(full_record());
  json["record"].erase(json["record"].size() - 1);
  EXPECT_THROW(unpack(json, record), Error);
}

}  // namespace
}  // namespace qtrace::experiments
