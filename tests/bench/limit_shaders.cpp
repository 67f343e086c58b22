#include "tests/bench/limit_shaders.h"

#include "engine/gpu/driver.h"
#include "engine/gpu/structs.h"

#include <algorithm>
#include <string>
#include <string_view>

namespace qtrace::bench {
namespace {

constexpr std::uint32_t kGroup = 64;
constexpr std::uint32_t kInvocations = 1U << 20;
constexpr std::uint32_t kTurns = 64;
constexpr std::uint32_t kChains = 16;                    // of multiply-adds that do not wait for each other
constexpr std::size_t kCachedNodes = 512;                // 16 KiB
constexpr std::uint32_t kFetchedNodes = 32;              // by an invocation
constexpr std::size_t kCopied = std::size_t{128} << 20;  // beyond caches; llvmpipe allows no more

// Results depend on everything, so that nothing is left out.
constexpr std::string_view kArithmetic = R"(#version 450 core
#include "shared/structs.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = BINDING_OUTPUT) restrict writeonly buffer OutputBuffer { float results[]; };
void main() {
  uint index = gl_GlobalInvocationID.x;
  vec4 a = vec4(index) * 1e-9;
  vec4 b = a + 0.1;
  vec4 c = a + 0.2;
  vec4 d = a + 0.3;
  vec4 factor = vec4(0.999) - a;
  for (int turn = 0; turn < TURNS; ++turn) {
    a = fma(a, factor, factor);
    b = fma(b, factor, factor);
    c = fma(c, factor, factor);
    d = fma(d, factor, factor);
  }
  vec4 sum = a + b + c + d;
  results[index] = sum.x + sum.y + sum.z + sum.w;
}
)";

constexpr std::string_view kFetch = R"(#version 450 core
#include "geometry/scene.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = BINDING_OUTPUT) restrict writeonly buffer OutputBuffer { uint results[]; };
void main() {
  uint index = gl_GlobalInvocationID.x;
  uint state = index * 747796405u + 2891336453u;
  uvec4 sum = uvec4(0u);
  for (int turn = 0; turn < TURNS; ++turn) {
    state = state * 1664525u + 1013904223u;
    uint node;
    uint fraction;
    umulExtended(state, NODES, node, fraction);
    sum += fetch(nodes, 2u * node) ^ fetch(nodes, 2u * node + 1u);
  }
  results[index] = sum.x ^ sum.y ^ sum.z ^ sum.w;
}
)";

constexpr std::string_view kCopy = R"(#version 450 core
#include "shared/structs.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = BINDING_SAMPLES) restrict readonly buffer InputBuffer { vec4 from[]; };
layout(std430, binding = BINDING_OUTPUT) restrict writeonly buffer OutputBuffer { vec4 to[]; };
void main() {
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uint index = group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  to[index] = from[index];
}
)";

gpu::Program program_of(const std::string& name, std::string_view text, gpu::Defines defines) {
  return gpu::Program(gpu::assemble(name, text, gpu::for_driver(std::move(defines))));
}

}  // namespace

ArithmeticLimit::ArithmeticLimit()
    : output_("results", kInvocations * sizeof(float)),
      program_(program_of("bench_arithmetic.comp", kArithmetic, {{"TURNS", std::to_string(kTurns)}})) {}

void ArithmeticLimit::run() const {
  output_.bind_storage(gpu::BINDING_OUTPUT);
  program_.dispatch(kInvocations / kGroup);
}

double ArithmeticLimit::operations() { return double{kInvocations} * kTurns * kChains; }

FetchLimit::FetchLimit(std::size_t nodes)
    : output_("results", kInvocations * sizeof(std::uint32_t)),
      program_(program_of("bench_fetch.comp", kFetch,
                          {{"TURNS", std::to_string(kFetchedNodes)},
                           {"NODES", std::to_string(std::min(nodes, kCachedNodes)) + "u"}})) {}

void FetchLimit::run() const {
  output_.bind_storage(gpu::BINDING_OUTPUT);
  program_.dispatch(kInvocations / kGroup);
}

double FetchLimit::elements() { return double{kInvocations} * kFetchedNodes * 2; }

MemoryLimit::MemoryLimit()
    : from_("copied", kCopied), to_("copy", kCopied), program_(program_of("bench_copy.comp", kCopy, {})) {}

void MemoryLimit::run() const {
  from_.bind_storage(gpu::BINDING_SAMPLES);
  to_.bind_storage(gpu::BINDING_OUTPUT);
  constexpr std::uint32_t kRows = 8;  // of work groups: a row holds 65,535 at most
  program_.dispatch(static_cast<std::uint32_t>(kCopied / sizeof(glm::vec4) / kGroup / kRows), kRows);
}

double MemoryLimit::bytes() { return 2.0 * kCopied; }

}  // namespace qtrace::bench
