#include "engine/tracer/shader_variant.h"

#include "engine/gpu/fetch.h"
#include "shaders/shared/variants.glsl"

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>

namespace qtrace {
namespace {

struct Numbered {
  std::string_view name;
  int value;   // of the enumerator
  int number;  // in variants.glsl
};
#define NUMBERED(Enum, enumerator, number) \
  Numbered { #enumerator, static_cast < int>(Enum::enumerator), number }

// Whether these are all enumerators of Choice, in their order, and host, shaders and configs mean the same by
// each.
template <class Choice>
constexpr bool agree(std::initializer_list<Numbered> enumerators) {
  if (enumerators.size() != EnumNames<Choice>::values.size()) return false;
  int place = 0;
  for (const Numbered& e : enumerators) {
    if (e.value != place || e.number != place) return false;
    if (e.name != EnumNames<Choice>::values[static_cast<std::size_t>(place)]) return false;
    ++place;
  }
  return true;
}

// A choice whose enum is not below has no number: choice() does not compile with it.
template <class Choice>
constexpr bool kIsNumbered = false;
template <>
constexpr bool kIsNumbered<RandomNumbers> = agree<RandomNumbers>(
    {NUMBERED(RandomNumbers, independent, RANDOM_INDEPENDENT), NUMBERED(RandomNumbers, sobol, RANDOM_SOBOL)});
template <>
constexpr bool kIsNumbered<Sampler> = agree<Sampler>({NUMBERED(Sampler, bsdf, SAMPLER_BSDF),
                                                      NUMBERED(Sampler, uniform, SAMPLER_UNIFORM),
                                                      NUMBERED(Sampler, rl, SAMPLER_RL)});
template <>
constexpr bool kIsNumbered<Nee> = agree<Nee>({NUMBERED(Nee, none, NEE_NONE),
                                              NUMBERED(Nee, one_ray, NEE_ONE_RAY),
                                              NUMBERED(Nee, two_ray, NEE_TWO_RAY)});
template <>
constexpr bool kIsNumbered<BvhKind> = agree<BvhKind>({NUMBERED(BvhKind, sah, BVH_SAH),
                                                      NUMBERED(BvhKind, threaded, BVH_THREADED)});
template <>
constexpr bool kIsNumbered<UpdateRule> = agree<UpdateRule>(
    {NUMBERED(UpdateRule, expected_sarsa, UPDATE_EXPECTED_SARSA), NUMBERED(UpdateRule, sarsa, UPDATE_SARSA),
     NUMBERED(UpdateRule, q_learning, UPDATE_Q_LEARNING),
     NUMBERED(UpdateRule, monte_carlo, UPDATE_MONTE_CARLO),
     NUMBERED(UpdateRule, paper_listing, UPDATE_PAPER_LISTING)});
template <>
constexpr bool kIsNumbered<Learns> = agree<Learns>({NUMBERED(Learns, all, LEARNS_ALL),
                                                    NUMBERED(Learns, beyond_nee, LEARNS_BEYOND_NEE)});
template <>
constexpr bool kIsNumbered<LearningRate> = agree<LearningRate>(
    {NUMBERED(LearningRate, visits_per_bin, RATE_VISITS_PER_BIN),
     NUMBERED(LearningRate, visits_per_cell, RATE_VISITS_PER_CELL),
     NUMBERED(LearningRate, constant, RATE_CONSTANT), NUMBERED(LearningRate, power, RATE_POWER)});
template <>
constexpr bool kIsNumbered<CellKind> = agree<CellKind>({NUMBERED(CellKind, voronoi, CELLS_VORONOI),
                                                        NUMBERED(CellKind, grid, CELLS_GRID)});
template <>
constexpr bool kIsNumbered<SiteSearch> = agree<SiteSearch>(
    {NUMBERED(SiteSearch, lists, SITE_SEARCH_LISTS), NUMBERED(SiteSearch, tree, SITE_SEARCH_TREE),
     NUMBERED(SiteSearch, linear, SITE_SEARCH_LINEAR)});
template <>
constexpr bool kIsNumbered<BinMap> = agree<BinMap>({NUMBERED(BinMap, cylindrical, BIN_MAP_CYLINDRICAL),
                                                    NUMBERED(BinMap, concentric, BIN_MAP_CONCENTRIC)});
template <>
constexpr bool kIsNumbered<InitialTable> = agree<InitialTable>(
    {NUMBERED(InitialTable, zero, INITIAL_ZERO), NUMBERED(InitialTable, constant, INITIAL_CONSTANT),
     NUMBERED(InitialTable, random, INITIAL_RANDOM), NUMBERED(InitialTable, cosine, INITIAL_COSINE)});
template <>
constexpr bool kIsNumbered<BinWeight> = agree<BinWeight>({NUMBERED(BinWeight, value, BIN_WEIGHT_VALUE),
                                                          NUMBERED(BinWeight, value_cosine,
                                                                   BIN_WEIGHT_VALUE_COSINE)});
template <>
constexpr bool kIsNumbered<Roulette> = agree<Roulette>({NUMBERED(Roulette, throughput, ROULETTE_THROUGHPUT),
                                                        NUMBERED(Roulette, reflectance, ROULETTE_REFLECTANCE),
                                                        NUMBERED(Roulette, value, ROULETTE_VALUE)});
#undef NUMBERED

// Chosen by the driver, not by a setting (engine/gpu/driver.cpp).
static_assert(static_cast<int>(gpu::Fetch::texture) == FETCH_TEXTURE &&
              static_cast<int>(gpu::Fetch::image) == FETCH_IMAGE &&
              static_cast<int>(gpu::Fetch::storage) == FETCH_STORAGE);

// Of scenes (engine/scene/texture.h).
static_assert(static_cast<int>(Wrap::repeat) == WRAP_REPEAT &&
              static_cast<int>(Wrap::mirrored_repeat) == WRAP_MIRRORED_REPEAT &&
              static_cast<int>(Wrap::clamp_to_edge) == WRAP_CLAMP_TO_EDGE);
static_assert(static_cast<int>(TextureSlot::base_color) == TEXTURE_BASE_COLOR &&
              static_cast<int>(TextureSlot::metallic_roughness) == TEXTURE_METALLIC_ROUGHNESS &&
              static_cast<int>(TextureSlot::normal) == TEXTURE_NORMAL &&
              static_cast<int>(TextureSlot::emission) == TEXTURE_EMISSION &&
              static_cast<int>(TextureSlot::specular) == TEXTURE_SPECULAR &&
              static_cast<int>(TextureSlot::specular_color) == TEXTURE_SPECULAR_COLOR &&
              static_cast<int>(TextureSlot::transmission) == TEXTURE_TRANSMISSION &&
              static_cast<int>(TextureSlot::clearcoat) == TEXTURE_CLEARCOAT &&
              static_cast<int>(TextureSlot::clearcoat_roughness) == TEXTURE_CLEARCOAT_ROUGHNESS &&
              static_cast<int>(TextureSlot::clearcoat_normal) == TEXTURE_CLEARCOAT_NORMAL);

template <class Choice>
std::string choice(Choice chosen) {
  static_assert(kIsNumbered<Choice>, "the enum and its numbers in shaders/shared/variants.glsl differ");
  return std::to_string(static_cast<int>(chosen));
}

bool has_constant_environment(const RenderSettings& settings) {
  return std::ranges::any_of(settings.environment, [](double e) { return e > 0; });
}

void define_table(gpu::Defines& defines, const RenderSettings& settings, const gpu::SceneFeatures& features) {
  defines["HAS_TABLE"] = "1";
  defines["LIGHT_ACTIONS"] = std::to_string(learns_lights(settings) ? features.lights : 0);
  defines["CELLS"] = choice(settings.rl.cells);
  defines["SITE_SEARCH"] = choice(settings.rl.site_search);
  defines["LEARNING_RATE"] = choice(settings.rl.learning_rate);
  defines["INITIAL_TABLE"] = choice(settings.rl.initial_table);
  if (settings.sampler != Sampler::rl) return;
  defines["BIN_MAP"] = choice(settings.rl.bin_map);
  defines["BINS_THETA"] = std::to_string(settings.rl.bins_theta);
  defines["BINS_PHI"] = std::to_string(settings.rl.bins_phi);
  defines["UPDATE_RULE"] = choice(settings.rl.update);
  defines["LEARNS"] = choice(settings.rl.learns);
  defines["ROULETTE"] = choice(settings.rl.roulette);
  defines["BIN_WEIGHT"] = choice(settings.rl.bin_weight);
  if (settings.rl.shrinkage > 0) defines["SHRINKS"] = "1";
  if (settings.rl.mixture == Mixture::learned) defines["LEARNS_MIXTURE"] = "1";
  if (settings.rl.bsdf_fraction > 0 || settings.rl.mixture == Mixture::learned) defines["MIXES_BSDF"] = "1";
  defines["MAX_VERTICES"] = std::to_string(std::max(settings.max_bounces, 1));
}

}  // namespace

RenderSettings effective_settings(RenderSettings settings, const gpu::SceneFeatures& features) {
  if (features.lights == 0) settings.nee = Nee::none;
  if (settings.random == RandomNumbers::independent) settings.replicates = 1;
  // What emits nothing has no paths, and what is seen without any event is the camera's alone.
  const bool is_dark = features.lights == 0 && !has_constant_environment(settings);
  if (is_dark || settings.max_bounces == 0) settings.light_paths = LightPaths::none;
  // A connection joins two events.
  if (settings.light_paths == LightPaths::connect && settings.max_bounces < 2)
    settings.light_paths = LightPaths::trace;
  return settings;
}

std::size_t table_actions(const RenderSettings& settings, const gpu::SceneFeatures& features) {
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
  defines["RANDOM"] = choice(settings.random);
  if (settings.random == RandomNumbers::sobol)
    defines["STRATIFIED_EVENTS"] = std::to_string(settings.stratified_events);
  defines["SAMPLER"] = choice(settings.sampler);
  defines["NEE"] = choice(settings.nee);
  defines["BVH"] = choice(settings.bvh);
  defines["LIGHT_ACTIONS"] = "0";
  if (features.specular) defines["HAS_SPECULAR"] = "1";
  if (features.textures != 0) defines["TEXTURES"] = std::to_string(features.textures);
  if (features.tangents) defines["HAS_TANGENTS"] = "1";
  if (features.colors) defines["HAS_COLORS"] = "1";
  if (features.transmission) defines["HAS_TRANSMISSION"] = "1";
  if (features.absorption) defines["HAS_ABSORPTION"] = "1";
  if (features.clearcoat) defines["HAS_CLEARCOAT"] = "1";
  if (features.delta) defines["HAS_DELTA"] = "1";
  if (features.transmission || features.clearcoat || features.delta) defines["HAS_OWN_LOBES"] = "1";
  if (features.unlit) defines["HAS_UNLIT"] = "1";
  if (features.alpha) defines["HAS_ALPHA"] = "1";
  if (features.punctual) defines["HAS_PUNCTUAL"] = "1";
  const bool has_sky = features.sky.x > 0;
  if (has_sky) {
    defines["HAS_SKY"] = "1";
    defines["SKY_LIGHT"] = std::to_string(features.lights - 1) + "u";
  }
  if (has_sky || has_constant_environment(settings)) defines["HAS_ENVIRONMENT"] = "1";
  if (settings.light_paths != LightPaths::none) defines["HAS_LIGHT_PATHS"] = "1";
  if (settings.light_paths == LightPaths::connect) defines["HAS_CONNECTIONS"] = "1";
  if (has_table(settings)) define_table(defines, settings, features);
  return defines;
}

}  // namespace qtrace
