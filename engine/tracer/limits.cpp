#include "engine/tracer/limits.h"

#include "engine/core/check.h"
#include "engine/gpu/buffer.h"
#include "engine/gpu/scene_buffers.h"
#include "engine/gpu/structs.h"
#include "engine/tracer/cell_buffers.h"
#include "engine/tracer/shader_variant.h"

namespace qtrace {
namespace {

constexpr int kLoopBudget = 65535;
constexpr int kSitesPerIteration = 4;  // of find_cell() in cells.glsl
constexpr int kLoopsPerColumn = 3;     // of learn.comp: visits, targets, distribution
// Registers of an invocation spill to memory for the lessons of monte_carlo.glsl, 48 bytes for each.
constexpr int kMostLessons = 64;

void check_loop_budget(const gpu::DeviceInfo& device, const RenderSettings& settings, std::size_t columns) {
  const bool is_limited = device.renderer.find("llvmpipe") != std::string::npos;
  if (!is_limited) return;
  check(columns <= kLoopBudget / kLoopsPerColumn / 2,
        "a table of {} columns (direction bins and learned lights) needs loops that the driver of this device "
        "({}) cuts after {} iterations; lower rl.bins_theta or rl.bins_phi, choose lights by power, or use "
        "another device",
        columns, device.renderer, kLoopBudget);
  const int sites = (settings.rl.sites_per_object + kSitesPerIteration - 1) / kSitesPerIteration;
  const int hits = settings.max_bounces + 1;
  check(sites <= kLoopBudget / 2 / hits,
        "a path of max_bounces {} over {} sites per object may need {} loop iterations, and the driver of "
        "this device ({}) cuts loops after {}; lower max_bounces or rl.sites_per_object, or use another device",
        settings.max_bounces, settings.rl.sites_per_object, sites * hits, device.renderer, kLoopBudget);
}

void check_lessons(const RenderSettings& settings) {
  if (settings.sampler != Sampler::rl || settings.rl.update != UpdateRule::monte_carlo) return;
  check(settings.max_bounces <= kMostLessons,
        "rl.update monte_carlo keeps all events of a path and allows max_bounces up to {}, not {}; lower it or "
        "choose another rule",
        kMostLessons, settings.max_bounces);
}

}  // namespace

void check_limits(const gpu::Context& context, const Scene& scene, const RenderSettings& settings) {
  const auto pixels = static_cast<std::size_t>(settings.width) * static_cast<std::size_t>(settings.height);
  gpu::check_buffer_size("pixel sums", pixels * sizeof(gpu::PixelSum));
  check_lessons(settings);
  const gpu::SceneFeatures features = gpu::find_features(scene);
  const RenderSettings effective = effective_settings(settings, features);
  if (!has_table(effective)) return;
  const std::size_t columns = table_columns(effective, features);
  gpu::check_buffer_size("Q targets (cells x columns)",
                         CellBuffers::count(scene, settings.rl) * columns * sizeof(gpu::TargetSum));
  check_loop_budget(context.device(), effective, columns);
}

}  // namespace qtrace
