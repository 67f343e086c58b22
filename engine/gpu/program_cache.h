// Programs that are compiled once for all that need the same.
#pragma once

#include "engine/gpu/program.h"

#include <cstddef>
#include <memory>
#include <string>
#include <unordered_map>

namespace qtrace::gpu {

class ProgramCache {
 public:
  // shaders/<name>, as Program compiles it. Two users of one program set its frame before each dispatch.
  std::shared_ptr<Program> get(const std::string& name, const Defines& defines);
  std::size_t compiled() const { return compiled_; }  // so far

 private:
  void drop_unused();

  std::unordered_map<std::string, std::shared_ptr<Program>> programs_;  // by their source text
  std::size_t compiled_ = 0;
};

}  // namespace qtrace::gpu
