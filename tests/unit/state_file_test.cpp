// States of tracers on disk: read back exactly, and refused where they are not whole.
#include "experiments/files/state_file.h"
#include "engine/core/check.h"
#include "tests/system/temp_folder.h"

#include <gtest/gtest.h>

namespace qtrace::experiments {
namespace {

StoredState small_state() {
  StoredState stored{{{"hash", "abc"}, {"n", 1.5}}, {77, {}}};
  stored.state.buffers.push_back({"z sums", {std::byte{0}, std::byte{255}, std::byte{10}}});
  stored.state.buffers.push_back({"a table", {}});
  return stored;
}

class StateFile : public testing::Test {
 protected:
  std::string error_of(const std::string& content) const {
    try {
      read_state(folder_.write("s.state", content));
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  tests::TempFolder folder_;
};

TEST_F(StateFile, IsReadBackExactly) {
  write_state(folder_ / "s.state", small_state());
  const StoredState read = read_state(folder_ / "s.state");
  EXPECT_EQ(read.about, small_state().about);
  EXPECT_EQ(read.state.frames, 77U);
  ASSERT_EQ(read.state.buffers.size(), 2U);
  EXPECT_EQ(read.state.buffers[0].name, "z sums");
  EXPECT_EQ(read.state.buffers[0].bytes, small_state().state.buffers[0].bytes);
  EXPECT_EQ(read.state.buffers[1].name, "a table");
  EXPECT_TRUE(read.state.buffers[1].bytes.empty());
}

TEST_F(StateFile, EveryChangedBitAndMissingByteIsSeen) {
  write_state(folder_ / "s.state", small_state());
  const std::string whole = folder_.read("s.state");
  EXPECT_EQ(error_of(whole), "no error");
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] ^= 4;
    EXPECT_NE(error_of(damaged).find("s.state: is no saved state"), std::string::npos) << i;
    EXPECT_NE(error_of(whole.substr(0, i)).find("s.state: is no saved state"), std::string::npos) << i;
  }
}

TEST_F(StateFile, MissingFilesAreNamed) {
  try {
    read_state(folder_ / "none.state");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("none.state"), std::string::npos);
  }
}

}  // namespace
}  // namespace qtrace::experiments
