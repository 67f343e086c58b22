#include "engine/tracer/limits.h"

#include "engine/core/check.h"

namespace qtrace {
namespace {

constexpr int kLoopBudget = 65535;
constexpr int kSitesPerIteration = 4;  // of find_cell() in cells.glsl

}  // namespace

void check_loop_budget(const gpu::DeviceInfo& device, const RenderSettings& settings) {
  if (settings.sampler != Sampler::rl || device.renderer.find("llvmpipe") == std::string::npos) return;
  const int hits = settings.max_bounces + 1;
  const int most_sites = kLoopBudget / 2 / hits * kSitesPerIteration;
  check(settings.rl.sites_per_object <= most_sites,
        "rl.sites_per_object is {}: with max_bounces {} this device ({}) can search at most {} sites, "
        "because its "
        "driver cuts the loops of a shader after {} iterations; lower one of the two or use another device",
        settings.rl.sites_per_object, settings.max_bounces, device.renderer, most_sites, kLoopBudget);
}

}  // namespace qtrace
