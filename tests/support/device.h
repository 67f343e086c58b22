// The one context of a test program.
#pragma once

#include "engine/gpu/context.h"

namespace qtrace::test {

inline gpu::Context& device() {
  static gpu::Context context;
  return context;
}

}  // namespace qtrace::test
