// The hierarchy that a tracer uses.
#pragma once

#include "engine/accel/bvh.h"

namespace qtrace {

// What a tracer uses: small leaves, as every ray of a SIMD group pays for the longest leaf among them.
Bvh build_bvh(const Scene& scene, BvhKind kind);

}  // namespace qtrace
