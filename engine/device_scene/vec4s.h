// Structs of different kinds in one buffer, which shaders fetch vec4 by vec4.
#pragma once

#include "engine/gpu/structs.h"

#include <cstring>
#include <vector>

namespace qtrace::gpu {

template <class T>
constexpr std::size_t vec4s_of() {
  static_assert(sizeof(T) % sizeof(vec4) == 0);
  return sizeof(T) / sizeof(vec4);
}

template <class T>
void append_vec4s(std::vector<vec4>& all, const T& packed) {
  all.resize(all.size() + vec4s_of<T>());
  std::memcpy(all.data() + all.size() - vec4s_of<T>(), &packed, sizeof(T));
}

}  // namespace qtrace::gpu
