// What the tracer can be told: one struct, each knob declared once (see knob.h).
#pragma once

#include "engine/core/knob.h"
#include "engine/core/rl_settings.h"

#include <array>
#include <cstdint>

namespace qtrace {

enum class RandomNumbers { independent, sobol };
enum class Sampler { bsdf, uniform, rl };
enum class Nee { none, one_ray, two_ray };
enum class LightChoice { uniform, power, learned };
enum class LightPaths { none, trace, connect };
enum class BvhKind { sah, threaded };

template <>
struct EnumNames<RandomNumbers> {
  static constexpr std::array<std::string_view, 2> values{"independent", "sobol"};
};
template <>
struct EnumNames<Sampler> {
  static constexpr std::array<std::string_view, 3> values{"bsdf", "uniform", "rl"};
};
template <>
struct EnumNames<Nee> {
  static constexpr std::array<std::string_view, 3> values{"none", "one_ray", "two_ray"};
};
template <>
struct EnumNames<LightChoice> {
  static constexpr std::array<std::string_view, 3> values{"uniform", "power", "learned"};
};
template <>
struct EnumNames<LightPaths> {
  static constexpr std::array<std::string_view, 3> values{"none", "trace", "connect"};
};
template <>
struct EnumNames<BvhKind> {
  static constexpr std::array<std::string_view, 2> values{"sah", "threaded"};
};

struct RenderSettings {
  int width = 512;
  int height = 512;
  std::uint32_t seed = 1;
  RandomNumbers random = RandomNumbers::sobol;
  int stratified_events = 1;
  int replicates = 1;
  int max_bounces = 5;
  int russian_roulette_start = 3;
  std::array<double, 3> environment{0, 0, 0};
  double clamp_radiance = 0;
  Sampler sampler = Sampler::rl;
  Nee nee = Nee::none;
  LightChoice lights = LightChoice::power;
  double light_floor = 0.2;
  int light_prior = 2;
  LightPaths light_paths = LightPaths::none;
  int light_path_count = 0;
  int light_path_trial = 4;
  BvhKind bvh = BvhKind::sah;
  RlSettings rl;

  bool operator==(const RenderSettings&) const = default;
};

// How many paths start at lights in every frame.
inline int light_paths_of_a_frame(const RenderSettings& settings) {
  if (settings.light_paths == LightPaths::none) return 0;
  return settings.light_path_count > 0 ? settings.light_path_count : settings.width * settings.height;
}

// Whether NEE picks its light from the table.
inline bool learns_lights(const RenderSettings& settings) {
  return settings.nee != Nee::none && settings.lights == LightChoice::learned;
}

// Whether there is a table at all: for directions, for lights, or for both.
inline bool has_table(const RenderSettings& settings) {
  return settings.sampler == Sampler::rl || learns_lights(settings);
}

// `environment`: the knob of this name, for what has more to say of it than RenderSettings::environment.
template <class Visitor, class Environment>
void visit_knobs(Visitor& visit, RenderSettings& settings, Environment& environment) {
  visit(KnobInfo{"width", "pixels", "image width", 1, 16384}, settings.width);
  visit(KnobInfo{"height", "pixels", "image height", 1, 16384}, settings.height);
  visit(KnobInfo{"seed", "", "seed of the random numbers: the same seed gives the same bits", 0,
                 std::numeric_limits<std::uint32_t>::max()},
        settings.seed);
  visit(
      KnobInfo{
          .name = "random",
          .unit = "",
          .help =
              "random numbers: independent ones, or Owen-scrambled Sobol' points, which fill the camera's "
              "and the first events' dimensions evenly",
          .implied = "\"independent\""},
      settings.random);
  visit(KnobInfo{"stratified_events", "scattering events",
                 "with random sobol: so many first events of a path draw from Sobol' points, the others from "
                 "independent numbers",
                 1, 8, "1"},
        settings.stratified_events);
  visit(KnobInfo{"replicates", "sequences",
                 "with random sobol: so many sequences of points, each scrambled on its own, take turns from "
                 "frame to "
                 "frame; with two or more their spread is the variance that images are kept with",
                 1, 64, "1"},
        settings.replicates);
  visit(KnobInfo{"max_bounces", "scattering events",
                 "longest path: 0 shows emission only, 1 adds direct light", 0, 1024},
        settings.max_bounces);
  visit(
      KnobInfo{"russian_roulette_start", "scattering events",
               "Russian roulette ends paths after more than this many; max_bounces or more: never", 0, 1024},
      settings.russian_roulette_start);
  visit(KnobInfo{"environment", "radiance, RGB",
                 "radiance of rays that leave the scene: the same for all, or an image's by their direction",
                 0, 1e8},
        environment);
  visit(KnobInfo{"clamp_radiance", "radiance",
                 "a sample with a channel above this is scaled down to it, which biases the image; 0: never",
                 0, 1e30},
        settings.clamp_radiance);
  visit(KnobInfo{"sampler", "", "how the next direction of a path is drawn"}, settings.sampler);
  visit(KnobInfo{"nee", "", "next event estimation: direct light by sampling the lights"}, settings.nee);
  visit(
      KnobInfo{
          "lights", "",
          "how next event estimation picks a light (a connected emitting surface, an image of the "
          "environment, a light without a surface): all alike, by power, or by what the cell has learned "
          "of it"},
      settings.lights);
  // The lower end keeps every light reachable, whatever was learned.
  visit(KnobInfo{"light_floor", "probability", "share of learned light choices that goes by power", 0.001, 1},
        settings.light_floor);
  visit(KnobInfo{"light_prior", "visits",
                 "how many visits of a light the guess that nothing hides a light counts for where lights "
                 "are learned; "
                 "0: no guess, by power at first",
                 0, 1000000},
        settings.light_prior);
  visit(
      KnobInfo{.name = "light_paths",
               .unit = "",
               .help = "paths that start at the lights, as many each frame as light_path_count says; trace: "
                       "each of their events is connected to the camera, and weighted against what the "
                       "camera's own paths find; connect: also each event of the camera's paths to one of "
                       "theirs",
               .implied = "\"none\""},
      settings.light_paths);
  visit(KnobInfo{"light_path_count", "paths",
                 "light paths of a frame, where there are any; 0: as many as pixels", 0, 268435456, "0"},
        settings.light_path_count);
  visit(KnobInfo{"light_path_trial", "frames",
                 "length of a trial of the light paths (an even number): before the first frame, a small "
                 "picture of the scene is rendered up to four times as often, every other time without them; "
                 "where error times work is less without them, the run does without; 0: no trial",
                 0, 1024, "4"},
        settings.light_path_trial);
  visit(
      KnobInfo{
          "bvh", "",
          "bounding volume hierarchy: split by surface area and walked in the order of distance, or that "
          "of Goswami 2020, split at medians and walked by links; images differ by rounding alone"},
      settings.bvh);
  visit(KnobInfo{"rl", "", "the table's cells and learning; used by sampler rl and by lights learned"},
        settings.rl);
}

template <class Visitor>
void visit_knobs(Visitor& visit, RenderSettings& settings) {
  visit_knobs(visit, settings, settings.environment);
}

}  // namespace qtrace
