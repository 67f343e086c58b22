#include "tests/bench/ray_shader.h"

#include "engine/core/check.h"
#include "engine/gpu/driver.h"
#include "engine/gpu/structs.h"

namespace qtrace::bench {
namespace {

constexpr std::size_t kGroup = 64;
constexpr int kRayUnit = 14;  // beside those of structs.glsl

// A negative t stands for a loop that was cut short.
constexpr std::string_view kShader = R"(#version 450 core
#include "geometry/traverse.glsl"
#include "shared/work_groups.glsl"
layout(local_size_x = 64) in;
FETCHED_VEC4(rays, 14);
layout(std430, binding = BINDING_OUTPUT) restrict writeonly buffer AnswerBuffer { vec2 answers[]; };

void main() {
  int index = int(dealt_group() * gl_WorkGroupSize.x + gl_LocalInvocationID.x);
  vec3 origin = fetch(rays, 2 * index).xyz;
  vec3 direction = fetch(rays, 2 * index + 1).xyz;
#ifdef OCCLUSION
  vec2 answer = vec2(is_occluded(origin, direction) ? 1.0 : 0.0, 0.0);
#else
  Hit hit = closest_hit(origin, direction);
  vec2 answer = vec2(hit.t, uintBitsToFloat(hit.triangle));
#endif
#ifdef COUNTED
  answer = vec2(float(walk_steps.COUNTED), 0.0);
#endif
  answers[index] = loop_was_cut ? vec2(-1.0, 0.0) : answer;
}
)";

// Whole work groups of them.
std::vector<BenchRay> padded(std::vector<BenchRay> rays) {
  check(!rays.empty(), "there is no ray to trace");
  rays.resize((rays.size() + kGroup - 1) / kGroup * kGroup, rays.back());
  return rays;
}

gpu::Defines with_kind(bool occlusion, gpu::Defines defines) {
  if (occlusion) defines["OCCLUSION"] = "1";
  return defines;
}

}  // namespace

RayBuffers::RayBuffers(const std::vector<BenchRay>& rays)
    : count_(rays.size()),
      rays_("bench rays", padded(rays), gpu::only_fetched(gpu::Texels::float4)),
      answers_("bench answers", rays_.bytes() / sizeof(BenchRay) * sizeof(Answer)) {}

void RayBuffers::bind() const {
  rays_.bind_fetched(kRayUnit);
  answers_.bind_storage(gpu::BINDING_OUTPUT);
}

std::uint32_t RayBuffers::groups() const {
  return static_cast<std::uint32_t>((count_ + kGroup - 1) / kGroup);
}

std::vector<Answer> RayBuffers::answers() const {
  std::vector<Answer> all = answers_.read_all<Answer>();
  all.resize(count_);
  for (const Answer& answer : all) {
    check(!(answer.t < 0), "the driver cut a loop of the ray query short: answers are wrong");
  }
  return all;
}

RayShader::RayShader(bool occlusion, gpu::Defines defines)
    : program_(gpu::assemble("bench_rays.comp", kShader,
                             gpu::for_driver(with_kind(occlusion, std::move(defines))))) {}

void RayShader::trace(const RayBuffers& rays) const {
  rays.bind();
  program_.dispatch(rays.groups());
}

}  // namespace qtrace::bench
