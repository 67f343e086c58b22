#include "experiments/files/file_queue.h"

#include "experiments/files/atomic_file.h"
#include "tests/system/temp_folder.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

TEST(FileQueue, WritesAllInTheirOrder) {
  const tests::TempFolder folder;
  FileQueue files;
  for (int i = 0; i < 100; ++i) files.put(folder / ("f" + std::to_string(i % 10)), std::to_string(i));
  files.put(folder / "gone", "x");
  files.remove(folder / "gone");
  files.remove(folder / "again");
  files.put(folder / "again", "y");
  files.flush();
  for (int i = 0; i < 10; ++i) EXPECT_EQ(folder.read("f" + std::to_string(i)), std::to_string(90 + i));
  EXPECT_FALSE(fs::exists(folder / "gone"));
  EXPECT_EQ(folder.read("again"), "y");
}

TEST(FileQueue, DoesNotWaitForTheDisk) {
  const tests::TempFolder folder;
  FileQueue files;
  std::atomic<bool> may_write = false;
  files.put(folder / "slow", 1, [&](const fs::path& temporary) {
    while (!may_write) std::this_thread::yield();
    write_bytes(temporary, "slow");
  });
  files.put(folder / "next", "next");  // returns at once
  EXPECT_FALSE(fs::exists(folder / "slow"));
  EXPECT_FALSE(fs::exists(folder / "next"));  // never before what was put first
  may_write = true;
  files.flush();
  EXPECT_EQ(folder.read("next"), "next");
}

// A manifest that says "finished" must not follow an image that was lost.
TEST(FileQueue, NothingFollowsALostFile) {
  const tests::TempFolder folder;
  FileQueue files;
  std::atomic<bool> has_begun = false, may_fail = false;
  files.put(folder / "lost", 1, [&](const fs::path&) {
    has_begun = true;
    while (!may_fail) std::this_thread::yield();
    fail("lost");
  });
  while (!has_begun) std::this_thread::yield();
  files.put(folder / "manifest", "finished");  // waits behind it
  may_fail = true;
  EXPECT_THROW(files.flush(), Error);
  EXPECT_FALSE(fs::exists(folder / "manifest"));
}

TEST(FileQueue, FailuresAreThrownWhereTheNextFileIsPut) {
  const tests::TempFolder folder;
  FileQueue files;
  files.put(folder / "missing/a", "a");
  try {
    for (int i = 0; i < 1000; ++i) {
      files.put(folder / ("b" + std::to_string(i)), "b");
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("missing/a: cannot be written"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(files.flush(), Error);
  files.put(folder / "c", "c");  // said once, it works again
  files.flush();
  EXPECT_EQ(folder.read("c"), "c");
}

// On request the content is made by the caller; the order and the failures stay.
TEST(FileQueue, ContentAtOnceIsMadeByTheCaller) {
  const tests::TempFolder folder;
  FileQueue files(FileQueue::Content::at_once);
  const auto caller = std::this_thread::get_id();
  for (int i = 0; i < 100; ++i) {
    files.put(folder / "same", 1, [&](const fs::path& temporary) {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      write_bytes(temporary, std::to_string(i));
    });
  }
  files.flush();
  EXPECT_EQ(folder.read("same"), "99");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);  // nothing unfinished is left
  EXPECT_THROW(files.put(folder / "missing/a", "a"), Error);
}

TEST(FileQueue, TheDestructorWritesTheRest) {
  const tests::TempFolder folder;
  { FileQueue().put(folder / "last", "last"); }
  EXPECT_EQ(folder.read("last"), "last");
}

}  // namespace
}  // namespace qtrace::experiments
