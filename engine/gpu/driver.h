// What shaders are compiled for besides scene and run: the driver of the current context.
#pragma once

#include "engine/gpu/shader_source.h"

namespace qtrace::gpu {

bool is_llvmpipe();

// Among how many threads the driver splits the work groups of a dispatch by place, each getting one
// contiguous run (shaders/shared/work_groups.glsl); 1 where there is no such split.
unsigned work_threads();

// With what suits the driver, unless the defines say so themselves: FETCH (fetch.h) and WORK_THREADS.
Defines for_driver(Defines defines);

}  // namespace qtrace::gpu
