// Mesa's software driver, as far as something must be known of it that OpenGL does not tell.
#pragma once

namespace qtrace::gpu {

// Whether the current context is of it.
bool is_llvmpipe();

// On how many threads it computes.
unsigned llvmpipe_threads();

}  // namespace qtrace::gpu
