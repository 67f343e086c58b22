#include "engine/tracer/limits.h"

#include "engine/cells/site_counts.h"
#include "engine/core/check.h"
#include "engine/device_scene/scene_buffers.h"
#include "engine/gpu/buffer.h"
#include "engine/gpu/structs.h"
#include "engine/tracer/cell_buffers.h"
#include "engine/tracer/qtable.h"
#include "engine/tracer/shader_variant.h"

#include <algorithm>
#include <bit>

namespace qtrace {
namespace {

constexpr int kLoopsPerAction = 3;     // of learn.comp: visits, targets, distribution
constexpr int kSitesPerIteration = 4;  // of the linear search in voronoi.glsl
// Turns of the search through a tree of sites, for each of its levels. Two to three are usual, twenty were
// seen; no bound below the number of sites holds everywhere, and a search that is cut is detected
// (loop_was_cut).
constexpr int kTurnsPerLevel = 20;
// Registers of an invocation spill to memory for the vertices of monte_carlo.glsl, 44 bytes for each.
constexpr int kMostVertices = 64;

// Turns of a loop that one search for a cell may take.
int search_turns(const Scene& scene, const RlSettings& settings) {
  if (settings.cells == CellKind::grid) return 0;
  const std::vector<std::uint32_t> counts = site_counts(scene, settings);
  const std::uint32_t most = counts.empty() ? 0 : std::ranges::max(counts);
  if (settings.site_search != SiteSearch::linear) {  // a list that is empty leaves the tree
    return kTurnsPerLevel * static_cast<int>(std::bit_width(most));
  }
  return (static_cast<int>(most) + kSitesPerIteration - 1) / kSitesPerIteration;
}

void check_loop_budget(const gpu::DeviceInfo& device, const Scene& scene, const RenderSettings& settings,
                       std::size_t actions) {
  if (device.loop_limit == 0) return;
  const auto budget = static_cast<int>(device.loop_limit);
  check(
      actions <= static_cast<std::size_t>(budget / kLoopsPerAction / 2),
      "a table of {} actions (direction bins and learned lights) needs loops that the driver of this device "
      "({}) cuts after {} iterations; lower rl.bins_theta or rl.bins_phi, choose lights by power, or use "
      "another device",
      actions, device.renderer, budget);
  const int turns = search_turns(scene, settings.rl);
  const int hits = settings.max_bounces + 1;
  const bool is_linear = settings.rl.site_search == SiteSearch::linear;
  check(turns <= budget / 2 / hits,
        "a path of max_bounces {}, with up to {} turns of the search for each of its cells, may need {} loop "
        "iterations, and the driver of this device ({}) cuts loops after {}; lower max_bounces{}, or use "
        "another device",
        settings.max_bounces, turns, std::int64_t{turns} * hits, device.renderer, budget,
        is_linear ? ", choose rl.site_search lists, lower the number of sites" : "");
}

// What the count of a sum holds: see TargetSum in structs.glsl.
constexpr std::uint32_t kMostTargets =
    1U << (gpu::SUM_LOW_COUNT_BITS + gpu::SUM_MIDDLE_COUNT_BITS + gpu::SUM_HIGH_COUNT_BITS);

std::uint64_t most_targets_in_a_frame(const RenderSettings& settings) {
  const auto paths = static_cast<std::uint64_t>(settings.width) * static_cast<std::uint64_t>(settings.height);
  return paths * (static_cast<std::uint64_t>(settings.max_bounces) + 1);
}

void check_targets(const RenderSettings& settings) {
  check(most_taught_frames(settings) > 0,
        "{}x{} pixels with max_bounces {} may teach one entry of the table {} times in a frame, and up to {} "
        "are "
        "counted; lower width, height or max_bounces",
        settings.width, settings.height, settings.max_bounces, most_targets_in_a_frame(settings),
        kMostTargets - 1);
}

void check_vertices(const RenderSettings& settings) {
  if (settings.sampler != Sampler::rl || settings.rl.update != UpdateRule::monte_carlo) return;
  check(
      settings.max_bounces <= kMostVertices,
      "rl.update monte_carlo keeps all events of a path and allows max_bounces up to {}, not {}; lower it or "
      "choose another rule",
      kMostVertices, settings.max_bounces);
}

// Without light samples they would be left out of the integral in silence.
void check_punctual(const Scene& scene, const RenderSettings& settings) {
  if (settings.nee != Nee::none || scene.lights.empty()) return;
  const PunctualLight& light = scene.lights.front();
  fail(
      "the light '{}' of the scene {} has no surface that a path could meet, and nee is none; one_ray or "
      "two_ray would be right",
      light.name, scene.name);
}

// What their weights would have to know of the camera's side, and do not.
void check_light_paths(const RenderSettings& settings) {
  if (settings.light_paths == LightPaths::none) return;
  check(settings.nee != Nee::two_ray,
        "light_paths {} weighs its paths against nee one_ray or none, not against two_ray, which draws two "
        "samples towards one light; set nee to one_ray",
        enum_name(settings.light_paths));
  check(settings.sampler != Sampler::rl || settings.rl.guided_bounces >= settings.max_bounces,
        "light_paths {} cannot tell how far from the camera an event of its paths will be, but "
        "rl.guided_bounces {} is less than max_bounces {}; raise it to {} or more",
        enum_name(settings.light_paths), settings.rl.guided_bounces, settings.max_bounces,
        settings.max_bounces);
  gpu::check_buffer_size("light paths",
                         static_cast<std::size_t>(light_paths_of_a_frame(settings)) * sizeof(gpu::uvec4));
}

}  // namespace

static_assert(sizeof(gpu::FirstHit) >= sizeof(gpu::PixelSum) &&
              sizeof(gpu::FirstHit) >= sizeof(gpu::PixelSample) &&
              sizeof(gpu::FirstHit) >= sizeof(gpu::PixelOutliers));

std::uint32_t most_taught_frames(const RenderSettings& settings) {
  return static_cast<std::uint32_t>((kMostTargets - 1) / most_targets_in_a_frame(settings));
}

void check_limits(const gpu::Context& context, const Scene& scene, const RenderSettings& settings) {
  const auto pixels = static_cast<std::size_t>(settings.width) * static_cast<std::size_t>(settings.height);
  gpu::check_buffer_size("first hits", pixels * sizeof(gpu::FirstHit));  // the largest of those with pixels
  check_punctual(scene, settings);
  gpu::check_texels(scene);
  check_vertices(settings);
  check_light_paths(settings);
  const gpu::SceneFeatures features = gpu::find_features(scene);
  const RenderSettings effective = effective_settings(settings, features);
  if (!has_table(effective)) return;
  const std::size_t actions = table_actions(effective, features);
  check_targets(effective);
  CellBuffers::check_size(scene, settings.rl);
  QTable::check_size(CellBuffers::count(scene, settings.rl), actions);
  check_loop_budget(context.device(), scene, effective, actions);
}

}  // namespace qtrace
