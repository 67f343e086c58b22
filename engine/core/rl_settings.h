// The Q-table: its states (cells), its actions (direction bins), how it learns and how it is sampled.
#pragma once

#include "engine/core/knob.h"

#include <array>

namespace qtrace {

enum class UpdateRule { expected_sarsa, sarsa, q_learning, monte_carlo, paper_listing };
enum class Learns { all, beyond_nee };
enum class LearningRate { visits_per_bin, visits_per_cell, constant, power };
enum class CellKind { voronoi, grid };
enum class SitePlacement { uv, area };
enum class SiteSearch { lists, tree, linear };
enum class BinMap { cylindrical, concentric };
enum class InitialTable { zero, constant, random, cosine };
enum class BinWeight { value, value_cosine };
enum class Mixture { fixed, learned };
enum class Roulette { throughput, reflectance, value };

template <>
struct EnumNames<UpdateRule> {
  static constexpr std::array<std::string_view, 5> values{"expected_sarsa", "sarsa", "q_learning",
                                                          "monte_carlo", "paper_listing"};
};
template <>
struct EnumNames<Learns> {
  static constexpr std::array<std::string_view, 2> values{"all", "beyond_nee"};
};
template <>
struct EnumNames<LearningRate> {
  static constexpr std::array<std::string_view, 4> values{"visits_per_bin", "visits_per_cell", "constant",
                                                          "power"};
};
template <>
struct EnumNames<CellKind> {
  static constexpr std::array<std::string_view, 2> values{"voronoi", "grid"};
};
template <>
struct EnumNames<SitePlacement> {
  static constexpr std::array<std::string_view, 2> values{"uv", "area"};
};
template <>
struct EnumNames<SiteSearch> {
  static constexpr std::array<std::string_view, 3> values{"lists", "tree", "linear"};
};
template <>
struct EnumNames<BinMap> {
  static constexpr std::array<std::string_view, 2> values{"cylindrical", "concentric"};
};
template <>
struct EnumNames<InitialTable> {
  static constexpr std::array<std::string_view, 4> values{"zero", "constant", "random", "cosine"};
};

template <>
struct EnumNames<BinWeight> {
  static constexpr std::array<std::string_view, 2> values{"value", "value_cosine"};
};
template <>
struct EnumNames<Mixture> {
  static constexpr std::array<std::string_view, 2> values{"fixed", "learned"};
};
template <>
struct EnumNames<Roulette> {
  static constexpr std::array<std::string_view, 3> values{"throughput", "reflectance", "value"};
};

struct RlSettings {
  UpdateRule update = UpdateRule::expected_sarsa;
  Learns learns = Learns::beyond_nee;
  LearningRate learning_rate = LearningRate::visits_per_bin;
  double rate_constant = 0.05;
  double rate_exponent = 0.7;
  CellKind cells = CellKind::voronoi;
  SitePlacement site_placement = SitePlacement::area;
  int sites_per_object = 0;
  int total_sites = 1000;
  SiteSearch site_search = SiteSearch::lists;
  double cell_normal_threshold = 0.866;
  int grid_resolution = 16;
  BinMap bin_map = BinMap::cylindrical;
  int bins_theta = 16;
  int bins_phi = 16;
  InitialTable initial_table = InitialTable::zero;
  double initial_value = 1;
  BinWeight bin_weight = BinWeight::value_cosine;
  double shrinkage = 4;
  Mixture mixture = Mixture::learned;
  double bsdf_fraction = 0.5;
  double bin_floor = 0.03;
  double roulette_scale = 3;
  int teach_frames = 16;
  double update_growth = 0.1;
  int guided_bounces = 1024;
  int trial_frames = 4;
  Roulette roulette = Roulette::value;

  bool operator==(const RlSettings&) const = default;
};

template <class Visitor>
void visit_knobs(Visitor& visit, RlSettings& rl) {
  visit(KnobInfo{"update", "", "target of the temporal-difference update"}, rl.update);
  visit(
      KnobInfo{"learns", "",
               "what a value holds: all radiance that arrives, or what of it next event estimation leaves to "
               "the path's own rays"},
      rl.learns);
  visit(
      KnobInfo{
          "learning_rate", "",
          "how far one target moves a value: 1/(1 + visits) of the bin or of the cell, rate_constant, or "
          "(1 + visits of the bin)^-rate_exponent"},
      rl.learning_rate);
  visit(KnobInfo{"rate_constant", "", "learning rate of learning_rate constant", 1e-6, 1}, rl.rate_constant);
  // The sum of rates must diverge and the sum of their squares must not (Robbins & Monro 1951).
  visit(KnobInfo{"rate_exponent", "", "exponent of learning_rate power", 0.51, 1}, rl.rate_exponent);
  visit(KnobInfo{"cells", "",
                 "states: Voronoi cells on the surfaces, or a regular grid of boxes with six normals each"},
        rl.cells);
  visit(KnobInfo{"site_placement", "", "where Voronoi sites stand: through the UV map, or by area"},
        rl.site_placement);
  visit(KnobInfo{"sites_per_object", "sites", "Voronoi sites on each object; 0: total_sites", 0, 100000},
        rl.sites_per_object);
  visit(
      KnobInfo{
          "total_sites", "sites",
          "Voronoi sites of the whole scene, shared among its objects by area (at least one each), where "
          "sites_per_object is 0",
          1, 1e7},
      rl.total_sites);
  visit(
      KnobInfo{
          "site_search", "",
          "how a hit finds its site: through lists of those that can be nearest in a box, through a tree, or "
          "linear through all of the object's (Goswami 2020); each finds the same"},
      rl.site_search);
  visit(KnobInfo{"cell_normal_threshold", "cosine",
                 "a site serves a hit point only if the cosine between their normals exceeds this", -1, 1},
        rl.cell_normal_threshold);
  visit(KnobInfo{"grid_resolution", "boxes", "boxes of cells grid along the scene's longest side", 1, 256},
        rl.grid_resolution);
  visit(KnobInfo{"bin_map", "",
                 "direction bins as patches of cosine and azimuth (Goswami 2020), or of a square mapped "
                 "concentrically; equal in solid angle either way"},
        rl.bin_map);
  visit(KnobInfo{"bins_theta", "bins", "rows of direction bins: along the cosine, or one side of the square",
                 1, 64},
        rl.bins_theta);
  visit(
      KnobInfo{"bins_phi", "bins", "columns of direction bins: along the azimuth, or the other side", 1, 64},
      rl.bins_phi);
  visit(KnobInfo{"initial_table", "",
                 "values before anything is learned: zero, initial_value, random in [0, initial_value) "
                 "(Goswami 2020), or initial_value times the bin's mean cosine"},
        rl.initial_table);
  visit(KnobInfo{"initial_value", "radiance", "scale of an initial table other than zero", 1e-6, 1e6},
        rl.initial_value);
  visit(KnobInfo{"bin_weight", "",
                 "what a bin is drawn in proportion to: its value, or that times the bin's mean cosine"},
        rl.bin_weight);
  visit(KnobInfo{"shrinkage", "samples",
                 "how many samples the mean of a bin's block counts for beside the bin's own, and the cell's "
                 "mean beside the block's; 0: a bin's value is its own",
                 0, 1e6},
        rl.shrinkage);
  visit(
      KnobInfo{"mixture", "",
               "share of directions drawn from the BSDF: bsdf_fraction everywhere, or learned in every cell, "
               "starting from that"},
      rl.mixture);
  visit(KnobInfo{"bsdf_fraction", "probability",
                 "share of directions drawn from the BSDF instead of the table; 0 is Goswami 2020", 0, 1},
        rl.bsdf_fraction);
  // The lower end keeps every bin reachable whatever was learned; without it the estimator is biased.
  visit(KnobInfo{"bin_floor", "probability", "share of table-drawn directions that picks its bin uniformly",
                 0.001, 1},
        rl.bin_floor);
  visit(
      KnobInfo{
          "teach_frames", "frames",
          "so many frames teach the table all that they find, of later ones only the share teach_frames / "
          "frame; 0: all frames",
          0, 1e6},
      rl.teach_frames);
  visit(KnobInfo{"update_growth", "",
                 "with random independent: the table is updated when the frames since its last update are "
                 "this share of those "
                 "before it (at most 32 frames); 0: after every frame. With random sobol it is updated after "
                 "frames 1, 2, 4, 8, "
                 "...",
                 0, 1},
        rl.update_growth);
  visit(KnobInfo{"guided_bounces", "scattering events",
                 "so many first events of a path draw their directions with the table and teach it; the "
                 "others sample "
                 "the BSDF",
                 1, 1024},
        rl.guided_bounces);
  visit(
      KnobInfo{
          "trial_frames", "frames",
          "length of a trial of the table (an even number): before the first frame, a small picture of "
          "the scene teaches the table for twice as many frames and then is rendered up to four times as "
          "often, every other time without the table; where error times work is less without it, the "
          "run does without; where that cannot be told, frames 17 to 32 and then 65 to 80 (for 4) try "
          "again; 0: no trial; none where lights are learned",
          0, 1024},
      rl.trial_frames);
  visit(
      KnobInfo{
          "roulette", "",
          "what Russian roulette goes by: the path's throughput; what that would be had the BSDF drawn the "
          "same directions (the first ends paths where the table sent many, since each then counts for "
          "less); "
          "or what the table expects of the rest of the path, over what it expected at its start"},
      rl.roulette);
  visit(
      KnobInfo{
          "roulette_scale", "",
          "of roulette value: a path goes on with this times what it is expected to bring, over what it was "
          "expected to at its start; larger: longer paths, less noise",
          0.01, 100},
      rl.roulette_scale);
}

}  // namespace qtrace
