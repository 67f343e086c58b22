#include "engine/tracer/shader_variant.h"

#include <algorithm>
#include <string>

namespace qtrace {
namespace {

template <class Choice>
std::string number(Choice choice) {
  return std::to_string(static_cast<int>(choice));
}

void define_table(gpu::Defines& defines, const RenderSettings& settings, const gpu::SceneFeatures& features) {
  defines["HAS_TABLE"] = "1";
  defines["LIGHT_COLUMNS"] = number(learns_lights(settings) ? features.lights : 0);
  defines["CELLS"] = number(settings.rl.cells);
  defines["SITE_SEARCH"] = number(settings.rl.site_search);
  defines["LEARNING_RATE"] = number(settings.rl.learning_rate);
  defines["INITIAL_TABLE"] = number(settings.rl.initial_table);
  if (settings.sampler != Sampler::rl) return;
  defines["BIN_MAP"] = number(settings.rl.bin_map);
  defines["BINS_THETA"] = number(settings.rl.bins_theta);
  defines["BINS_PHI"] = number(settings.rl.bins_phi);
  defines["UPDATE_RULE"] = number(settings.rl.update);
  defines["LEARNS"] = number(settings.rl.learns);
  defines["ROULETTE"] = number(settings.rl.roulette);
  defines["BIN_WEIGHT"] = number(settings.rl.bin_weight);
  if (settings.rl.shrinkage > 0) defines["SHRINKS"] = "1";
  if (settings.rl.mixture == Mixture::learned) defines["LEARNS_MIXTURE"] = "1";
  if (settings.rl.bsdf_fraction > 0 || settings.rl.mixture == Mixture::learned) defines["MIXES_BSDF"] = "1";
  defines["MAX_LESSONS"] = number(std::max(settings.max_bounces, 1));
}

}  // namespace

RenderSettings effective_settings(RenderSettings settings, const gpu::SceneFeatures& features) {
  if (features.lights == 0) settings.nee = Nee::none;
  return settings;
}

std::size_t table_columns(const RenderSettings& settings, const gpu::SceneFeatures& features) {
  const bool learns_directions = settings.sampler == Sampler::rl;
  const int bins = learns_directions ? settings.rl.bins_theta * settings.rl.bins_phi : 0;
  const std::size_t sides = learns_directions && settings.rl.mixture == Mixture::learned ? 2 : 0;
  return static_cast<std::size_t>(bins) + (learns_lights(settings) ? features.lights : 0) + sides;
}

gpu::Defines with_cells(gpu::Defines defines, const CellBuffers& cells) {
  if (cells.lists_are_complete()) defines["LISTS_ARE_COMPLETE"] = "1";
  return defines;
}

gpu::Defines shader_defines(const RenderSettings& wanted, const gpu::SceneFeatures& features) {
  const RenderSettings settings = effective_settings(wanted, features);
  gpu::Defines defines;
  defines["SAMPLER"] = number(settings.sampler);
  defines["NEE"] = number(settings.nee);
  defines["BVH"] = number(settings.bvh);
  defines["LIGHT_COLUMNS"] = "0";
  if (features.specular) defines["HAS_SPECULAR"] = "1";
  if (std::ranges::any_of(settings.environment, [](double e) { return e > 0; }))
    defines["HAS_ENVIRONMENT"] = "1";
  if (has_table(settings)) define_table(defines, settings, features);
  return defines;
}

}  // namespace qtrace
