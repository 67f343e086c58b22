// The one context of a test program.
#pragma once

#include "engine/gpu/context.h"

namespace qtrace::test {

inline const gpu::Context& device() {
  static const gpu::Context context;
  return context;
}

}  // namespace qtrace::test
