#include "engine/tracer/limits.h"

#include "engine/core/check.h"

namespace qtrace {
namespace {

constexpr int kLoopBudget = 65535;
constexpr int kSitesPerIteration = 4;  // of find_cell() in cells.glsl

}  // namespace

void check_loop_budget(const gpu::DeviceInfo& device, const RenderSettings& settings,
                       const gpu::SceneFeatures& features) {
  const bool is_limited = device.renderer.find("llvmpipe") != std::string::npos;
  if (settings.sampler != Sampler::rl || !is_limited) return;
  // next_value() of qtable.glsl: a quadrature over all bins.
  const bool sums_bins = features.specular && settings.rl.update == UpdateRule::expected_sarsa;
  const int bins = sums_bins ? settings.rl.bins_theta * settings.rl.bins_phi : 0;
  const int sites = (settings.rl.sites_per_object + kSitesPerIteration - 1) / kSitesPerIteration;
  const int hits = settings.max_bounces + 1;
  check(bins + sites <= kLoopBudget / 2 / hits,
        "a path of max_bounces {} over {} sites per object{} may need {} loop iterations, and the driver of "
        "this device "
        "({}) cuts loops after {}; lower max_bounces, rl.sites_per_object or the bins, or use another device",
        settings.max_bounces, settings.rl.sites_per_object,
        sums_bins ? fmt::format(" and {} bins at glossy surfaces", bins) : "", (bins + sites) * hits,
        device.renderer, kLoopBudget);
}

}  // namespace qtrace
