// How shaders fetch the buffers that they only read. What is fastest depends on the driver; the results are
// the same.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace qtrace::gpu {

// With the values in shaders/shared/variants.glsl (engine/tracer/shader_variant.cpp asserts it).
enum class Fetch { texture, image, storage };

// Whether the current context has as many units as shaders fetch from in this way (NVIDIA: 8 of images).
bool offers(Fetch fetch);

std::string fetch_name(Fetch fetch);
std::optional<Fetch> fetch_named(std::string_view name);

}  // namespace qtrace::gpu
