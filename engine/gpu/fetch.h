// How shaders fetch the buffers that they only read. What is fastest depends on the driver; the results are
// the same.
#pragma once

#include <string>

namespace qtrace::gpu {

// With the values in shaders/shared/variants.glsl (engine/tracer/shader_variant.cpp asserts it).
enum class Fetch { texture, image, storage };

// Of the current context. llvmpipe turns loads of storage into loops over the lanes of a SIMD register, and
// loads of images into gathers (./dev bench --variant NAME:FETCH=0,1,2 compares them); GPUs have a cache for
// textures.
Fetch best_fetch();

// Whether the current context has as many units as shaders fetch from in this way (NVIDIA: 8 of images).
bool offers(Fetch fetch);

std::string fetch_name(Fetch fetch);

}  // namespace qtrace::gpu
