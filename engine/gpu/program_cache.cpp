#include "engine/gpu/program_cache.h"

#include "engine/gpu/driver.h"

#include <utility>

namespace qtrace::gpu {
namespace {

// A sweep can have any number of variants; a few runs in a row share theirs.
constexpr std::size_t kMostPrograms = 64;

}  // namespace

std::shared_ptr<Program> ProgramCache::get(const std::string& name, const Defines& defines) {
  ShaderSource source = assemble(name, shader_file(name), for_driver(defines));
  const auto found = programs_.find(source.text);
  if (found != programs_.end()) return found->second;
  auto program = std::make_shared<Program>(source);
  ++compiled_;
  if (programs_.size() >= kMostPrograms) drop_unused();
  programs_.emplace(std::move(source.text), program);
  return program;
}

void ProgramCache::drop_unused() {
  std::erase_if(programs_, [](const auto& entry) { return entry.second.use_count() == 1; });
}

}  // namespace qtrace::gpu
