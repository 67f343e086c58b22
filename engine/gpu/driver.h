// What shaders are compiled for besides scene and run: what suits the driver of the current context. Nothing
// but time depends on it.
#pragma once

#include "engine/gpu/fetch.h"
#include "engine/gpu/shader_source.h"

#include <optional>
#include <string>
#include <string_view>

namespace qtrace::gpu {

// Where a walk through the hierarchy keeps the links that wait. In the order of the values in
// shaders/geometry/traverse.glsl.
enum class StackPlace { memory, registers };

std::string stack_name(StackPlace stack);
std::optional<StackPlace> stack_named(std::string_view name);

struct DriverChoices {
  Fetch fetch = Fetch::texture;
  StackPlace stack = StackPlace::memory;
  // Among how many threads the driver splits the work groups of a dispatch by place, each getting one
  // contiguous run (shaders/shared/work_groups.glsl); 1 where there is no such split.
  unsigned work_threads = 1;

  bool operator==(const DriverChoices&) const = default;
};

// Of the current context, from what was measured once: llvmpipe (Mesa 22.3) turns loads of storage into loops
// over the lanes of a SIMD register and loads of images into gathers, reads and writes memory lane by lane,
// and gives each of its threads a part of a dispatch. GPUs (NVIDIA's) have a cache for textures and want few
// registers.
DriverChoices usual_choices();

// Of the current context of this thread; a Context sets them.
const DriverChoices& driver_choices();
void set_driver_choices(const DriverChoices& choices);

// With these, unless the defines say so themselves: FETCH, STACK and WORK_THREADS.
Defines with_choices(Defines defines, const DriverChoices& choices);

// With those of the current context.
Defines for_driver(Defines defines);

}  // namespace qtrace::gpu
