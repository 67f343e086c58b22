// What the tracer can be told: one struct, each knob declared once (see knob.h).
#pragma once

#include "engine/core/knob.h"

#include <array>
#include <cstdint>

namespace qtrace {

enum class Sampler { bsdf, uniform, rl };
enum class Nee { none, one_ray, two_ray };
enum class UpdateRule { expected_sarsa, q_learning };
enum class LearningRate { visits_per_bin };
enum class SitePlacement { uv, area };
enum class InitialTable { zero, random };

template <>
struct EnumNames<Sampler> {
  static constexpr std::array<std::string_view, 3> values{"bsdf", "uniform", "rl"};
};
template <>
struct EnumNames<Nee> {
  static constexpr std::array<std::string_view, 3> values{"none", "one_ray", "two_ray"};
};
template <>
struct EnumNames<UpdateRule> {
  static constexpr std::array<std::string_view, 2> values{"expected_sarsa", "q_learning"};
};
template <>
struct EnumNames<LearningRate> {
  static constexpr std::array<std::string_view, 1> values{"visits_per_bin"};
};
template <>
struct EnumNames<InitialTable> {
  static constexpr std::array<std::string_view, 2> values{"zero", "random"};
};
template <>
struct EnumNames<SitePlacement> {
  static constexpr std::array<std::string_view, 2> values{"uv", "area"};
};

// The Q-table: its states (Voronoi cells), its actions (direction bins), how it learns and how it is sampled.
struct RlSettings {
  UpdateRule update = UpdateRule::expected_sarsa;
  LearningRate learning_rate = LearningRate::visits_per_bin;
  SitePlacement site_placement = SitePlacement::uv;
  int sites_per_object = 100;
  double cell_normal_threshold = 0.866;
  int bins_theta = 10;
  int bins_phi = 10;
  InitialTable initial_table = InitialTable::zero;
  double bsdf_fraction = 0.5;
  double bin_floor = 0.1;

  bool operator==(const RlSettings&) const = default;
};

template <class Visitor>
void visit_knobs(Visitor& visit, RlSettings& rl) {
  visit(KnobInfo{"update", "", "target of the temporal-difference update"}, rl.update);
  visit(KnobInfo{"learning_rate", "", "how far one update moves a value"}, rl.learning_rate);
  visit(KnobInfo{"site_placement", "", "where Voronoi sites stand: through the UV map, or by area"},
        rl.site_placement);
  visit(KnobInfo{"sites_per_object", "sites", "Voronoi sites on each object", 1, 100000},
        rl.sites_per_object);
  visit(KnobInfo{"cell_normal_threshold", "cosine",
                 "a site serves a hit point only if the cosine between their normals exceeds this", -1, 1},
        rl.cell_normal_threshold);
  visit(KnobInfo{"bins_theta", "bins", "direction bins along the polar angle, equal in cosine", 1, 64},
        rl.bins_theta);
  visit(KnobInfo{"bins_phi", "bins", "direction bins along the azimuth", 1, 64}, rl.bins_phi);
  visit(KnobInfo{"initial_table", "",
                 "values before anything is learned: zero, or random in [0, 1) (the report)"},
        rl.initial_table);
  visit(KnobInfo{"bsdf_fraction", "probability",
                 "share of directions drawn from the BSDF instead of the table; 0 is the report", 0, 1},
        rl.bsdf_fraction);
  // The lower end keeps every bin reachable whatever was learned; without it the estimator is biased.
  visit(KnobInfo{"bin_floor", "probability", "share of table-drawn directions that picks its bin uniformly",
                 0.001, 1},
        rl.bin_floor);
}

struct RenderSettings {
  int width = 512;
  int height = 512;
  std::uint32_t seed = 1;
  int max_bounces = 5;
  int russian_roulette_start = 3;
  std::array<double, 3> environment{0, 0, 0};
  Sampler sampler = Sampler::rl;
  Nee nee = Nee::none;
  RlSettings rl;

  bool operator==(const RenderSettings&) const = default;
};

template <class Visitor>
void visit_knobs(Visitor& visit, RenderSettings& settings) {
  visit(KnobInfo{"width", "pixels", "image width", 1, 16384}, settings.width);
  visit(KnobInfo{"height", "pixels", "image height", 1, 16384}, settings.height);
  visit(KnobInfo{"seed", "", "seed of the random numbers: the same seed gives the same bits", 0,
                 std::numeric_limits<std::uint32_t>::max()},
        settings.seed);
  visit(KnobInfo{"max_bounces", "scattering events",
                 "longest path: 0 shows emission only, 1 adds direct light", 0, 1024},
        settings.max_bounces);
  visit(
      KnobInfo{"russian_roulette_start", "scattering events",
               "Russian roulette ends paths after more than this many; max_bounces or more: never", 0, 1024},
      settings.russian_roulette_start);
  visit(KnobInfo{"environment", "radiance, RGB", "constant radiance of rays that leave the scene", 0, 1e8},
        settings.environment);
  visit(KnobInfo{"sampler", "", "how the next direction of a path is drawn"}, settings.sampler);
  visit(KnobInfo{"nee", "", "next event estimation: direct light by sampling the lights"}, settings.nee);
  visit(KnobInfo{"rl", "", "the Q-table; used by sampler rl alone"}, settings.rl);
}

}  // namespace qtrace
