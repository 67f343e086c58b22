#include "engine/gpu/llvmpipe.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <string>
#include <thread>

namespace qtrace::gpu {
namespace {

std::string gl_string(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text == nullptr ? "" : text;
}

// LP_MAX_THREADS: of Mesa 22.3 and of 25.0.
unsigned most_threads() {
  const std::string version = gl_string(GL_VERSION);
  const std::size_t mesa = version.find("Mesa ");
  constexpr std::size_t kWord = 5;
  const int major = mesa == std::string::npos ? 0 : std::atoi(version.c_str() + mesa + kWord);
  constexpr int kFirstWithMore = 23;
  return major < kFirstWithMore ? 16 : 32;
}

}  // namespace

bool is_llvmpipe() {
  return gl_string(GL_RENDERER).find("llvmpipe") != std::string::npos;
}

// As llvmpipe counts them. 0 of LP_NUM_THREADS: the calling thread does everything.
unsigned llvmpipe_threads() {
  const char* asked = std::getenv("LP_NUM_THREADS");
  const bool is_number = asked != nullptr && std::isdigit(static_cast<unsigned char>(*asked)) != 0;
  const auto count = is_number ? static_cast<unsigned>(std::strtoul(asked, nullptr, 10))
                               : std::thread::hardware_concurrency();
  return std::clamp(count, 1U, most_threads());
}

}  // namespace qtrace::gpu
