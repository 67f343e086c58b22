#include "engine/gpu/llvmpipe.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <string>
#include <thread>

namespace qtrace::gpu {
namespace {

// LP_MAX_THREADS of Mesa 22.3.
constexpr unsigned kMostThreads = 16;

}  // namespace

bool is_llvmpipe() {
  const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return renderer != nullptr && std::string(renderer).find("llvmpipe") != std::string::npos;
}

// As llvmpipe counts them. 0 of LP_NUM_THREADS: the calling thread does everything.
unsigned llvmpipe_threads() {
  const char* asked = std::getenv("LP_NUM_THREADS");
  const bool is_number = asked != nullptr && std::isdigit(static_cast<unsigned char>(*asked)) != 0;
  const auto count = is_number ? static_cast<unsigned>(std::strtoul(asked, nullptr, 10))
                               : std::thread::hardware_concurrency();
  return std::clamp(count, 1U, kMostThreads);
}

}  // namespace qtrace::gpu
