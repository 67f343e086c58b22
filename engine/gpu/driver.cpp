#include "engine/gpu/driver.h"

#include "engine/gpu/fetch.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <string>
#include <thread>

namespace qtrace::gpu {
namespace {

// LP_MAX_THREADS of Mesa 22.3.
constexpr unsigned kMostLlvmpipeThreads = 16;

// As llvmpipe counts them. 0 of LP_NUM_THREADS: the calling thread does everything.
unsigned llvmpipe_threads() {
  const char* asked = std::getenv("LP_NUM_THREADS");
  const bool is_number = asked != nullptr && std::isdigit(static_cast<unsigned char>(*asked)) != 0;
  const auto count = is_number ? static_cast<unsigned>(std::strtoul(asked, nullptr, 10))
                               : std::thread::hardware_concurrency();
  return std::clamp(count, 1U, kMostLlvmpipeThreads);
}

}  // namespace

bool is_llvmpipe() {
  const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  return renderer != nullptr && std::string(renderer).find("llvmpipe") != std::string::npos;
}

unsigned work_threads() { return is_llvmpipe() ? llvmpipe_threads() : 1; }

Defines for_driver(Defines defines) {
  defines.try_emplace("FETCH", std::to_string(static_cast<int>(best_fetch())));
  defines.try_emplace("WORK_THREADS", std::to_string(work_threads()));
  return defines;
}

}  // namespace qtrace::gpu
