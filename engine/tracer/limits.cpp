#include "engine/tracer/limits.h"

#include "engine/core/check.h"
#include "engine/gpu/buffer.h"
#include "engine/gpu/scene_buffers.h"
#include "engine/gpu/structs.h"
#include "engine/tracer/qtable.h"

namespace qtrace {
namespace {

constexpr int kLoopBudget = 65535;
constexpr int kSitesPerIteration = 4;  // of find_cell() in cells.glsl

void check_loop_budget(const gpu::DeviceInfo& device, const RenderSettings& settings, bool specular) {
  const bool is_limited = device.renderer.find("llvmpipe") != std::string::npos;
  if (settings.sampler != Sampler::rl || !is_limited) return;
  // next_value() of qtable.glsl: a quadrature over all bins.
  const bool sums_bins = specular && settings.rl.update == UpdateRule::expected_sarsa;
  const int bins = sums_bins ? settings.rl.bins_theta * settings.rl.bins_phi : 0;
  const int sites = (settings.rl.sites_per_object + kSitesPerIteration - 1) / kSitesPerIteration;
  const int hits = settings.max_bounces + 1;
  check(bins + sites <= kLoopBudget / 2 / hits,
        "a path of max_bounces {} over {} sites per object{} may need {} loop iterations, and the driver of "
        "this device ({}) cuts loops after {}; lower max_bounces, rl.sites_per_object or the bins, or use "
        "another device",
        settings.max_bounces, settings.rl.sites_per_object,
        sums_bins ? fmt::format(" and {} bins at glossy surfaces", bins) : "", (bins + sites) * hits,
        device.renderer, kLoopBudget);
}

}  // namespace

void check_limits(const gpu::Context& context, const Scene& scene, const RenderSettings& settings) {
  const auto pixels = static_cast<std::size_t>(settings.width) * static_cast<std::size_t>(settings.height);
  gpu::check_buffer_size("pixel sums", pixels * sizeof(gpu::PixelSum));
  if (settings.sampler == Sampler::rl) {
    gpu::check_buffer_size("Q targets (sites x bins)",
                           QTable::entries(scene, settings.rl) * sizeof(gpu::TargetSum));
  }
  check_loop_budget(context.device(), settings, gpu::is_specular(scene));
}

}  // namespace qtrace
