// Which of an experiment's runs a call does, and how.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace qtrace::experiments {

struct Shard {
  std::size_t index = 1;  // from 1
  std::size_t count = 1;

  bool is_whole() const { return count == 1; }
  std::string text() const;  // "2-of-4"
};

struct RunChoices {
  std::filesystem::path root = "results";
  Shard shard;
  std::string only;              // pattern of run ids with * and ?; empty: all
  bool fresh = false;            // earlier results are put aside instead of gone on with
  bool keep_failed = false;      // failed runs are not tried again
  bool fail_fast = false;        // the first failed run ends the work
  bool references_only = false;  // renders references alone
  bool merge = false;            // renders nothing: writes the files about the runs that are there
};

}  // namespace qtrace::experiments
