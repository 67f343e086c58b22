#include "experiments/records/record_json.h"

#include "engine/core/check.h"
#include "tests/support/members.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace qtrace::experiments {
namespace {

// Every member that a record has, known here or added tomorrow, with a value of its own.
RunRecord full_record() {
  RunRecord record;
  int last = 0;
  std::apply([&](Run&, auto&... measured) { (test::fill(measured, last), ...); }, test::members(record));
  return record;
}

// `record` from CBOR, with what the config says set as for a run that goes on.
RunRecord come_back(const RunRecord& record) {
  std::vector<std::uint8_t> bytes;
  Json::to_cbor(pack(record), bytes);
  RunRecord back;
  back.place = record.place;
  back.order = record.order;
  unpack(Json::from_cbor(bytes), back);
  return back;
}

// The members that differ, as their indices from the record's own down; but for the run.
std::vector<std::string> differences(const RunRecord& a, const RunRecord& b) {
  std::vector<std::string> found;
  const auto other = test::members(b);
  std::size_t i = 0;
  const auto next = [&]<class T>(const T& x, const T& y) {
    if constexpr (!std::is_same_v<T, Run>) test::find_differences(x, y, std::to_string(i), found);
    ++i;
  };
  std::apply([&](const auto&... x) { std::apply([&](const auto&... y) { (next(x, y), ...); }, other); },
             test::members(a));
  return found;
}

TEST(RecordJson, EveryMemberComesBackFromCbor) {
  const RunRecord record = full_record();
  // The values are there, and differ from what a new record has.
  ASSERT_EQ(record.frames.size(), 2U);
  ASSERT_EQ(record.snapshots.size(), 2U);
  ASSERT_TRUE(record.snapshots[1].filtered && record.snapshots[1].filtered->errors.reference);
  EXPECT_NE(record.frames[1].counters.clamped_samples, record.frames[0].counters.clamped_samples);
  // Each member but the run, and of the fireflies both.
  EXPECT_EQ(differences(record, RunRecord()).size(), test::member_count<RunRecord>());
  EXPECT_EQ(differences(record, come_back(record)), std::vector<std::string>{});
}

TEST(RecordJson, WhatIsMissingInfiniteOrHugeComesBack) {
  RunRecord record;
  record.reason = "a \"reason\"";
  record.frames.resize(1);
  record.frames[0].counters.paths = (std::uint64_t{1} << 63U) + 1;
  record.snapshots.resize(1);
  record.snapshots[0].errors.psnr_db = std::numeric_limits<double>::infinity();
  record.snapshots[0].errors.relmse = std::numeric_limits<double>::quiet_NaN();
  record.fireflies.brightest = 1e30;
  const RunRecord back = come_back(record);
  ASSERT_EQ(back.snapshots.size(), 1U);
  EXPECT_TRUE(std::isnan(back.snapshots[0].errors.relmse));
  record.snapshots[0].errors.relmse = 0;
  RunRecord rest = back;
  rest.snapshots[0].errors.relmse = 0;
  EXPECT_EQ(differences(record, rest), std::vector<std::string>{});
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
