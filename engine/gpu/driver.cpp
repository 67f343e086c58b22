#include "engine/gpu/driver.h"

#include "engine/gpu/llvmpipe.h"

#include <utility>

namespace qtrace::gpu {
namespace {

// Beside OpenGL's own current context, and like that one for each thread.
thread_local DriverChoices current;

}  // namespace

std::string stack_name(StackPlace stack) { return stack == StackPlace::memory ? "memory" : "registers"; }

std::optional<StackPlace> stack_named(std::string_view name) {
  for (const StackPlace stack : {StackPlace::memory, StackPlace::registers}) {
    if (stack_name(stack) == name) return stack;
  }
  return std::nullopt;
}

DriverChoices usual_choices() {
  if (!is_llvmpipe()) return {};
  return {Fetch::image, StackPlace::registers, llvmpipe_threads()};
}

const DriverChoices& driver_choices() { return current; }

void set_driver_choices(const DriverChoices& choices) { current = choices; }

Defines with_choices(Defines defines, const DriverChoices& choices) {
  defines.try_emplace("FETCH", std::to_string(static_cast<int>(choices.fetch)));
  defines.try_emplace("STACK", std::to_string(static_cast<int>(choices.stack)));
  defines.try_emplace("WORK_THREADS", std::to_string(choices.work_threads));
  return defines;
}

Defines for_driver(Defines defines) { return with_choices(std::move(defines), driver_choices()); }

}  // namespace qtrace::gpu
