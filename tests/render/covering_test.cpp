// Every choice of the table together with every choice of every other kind estimates the same image: a set of
// settings in which each pair of choices of two kinds occurs.
#include "engine/scene/analytic.h"
#include "tests/render/comparison.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <set>
#include <tuple>

namespace qtrace::test {
namespace {

struct Kind {
  std::string name;
  std::vector<std::function<void(RenderSettings&)>> choices;
};

template <class Value, class Member>
Kind kind_of(const std::string& name, std::initializer_list<Value> values, Member member) {
  Kind kind{name, {}};
  for (const Value value : values) {
    kind.choices.push_back([member, value](RenderSettings& s) { member(s) = value; });
  }
  return kind;
}

Kind states() {
  return {"state",
          {[](RenderSettings&) {}, [](RenderSettings& s) { s.rl.site_placement = SitePlacement::area; },
           [](RenderSettings& s) {
             s.rl.sites_per_object = 0;
             s.rl.total_sites = 400;
             s.rl.site_placement = SitePlacement::area;
             s.rl.site_search = SiteSearch::linear;
           },
           [](RenderSettings& s) {
             s.rl.cells = CellKind::grid;
             s.rl.grid_resolution = 8;
           }}};
}

// One kind, so that every way of choosing lights meets all else with either way of using them.
Kind direct_light() {
  Kind kind{"direct light", {[](RenderSettings& s) { s.nee = Nee::none; }}};
  for (const Nee nee : {Nee::one_ray, Nee::two_ray}) {
    for (const LightChoice lights : {LightChoice::uniform, LightChoice::power, LightChoice::learned}) {
      kind.choices.push_back([nee, lights](RenderSettings& s) {
        s.nee = nee;
        s.lights = lights;
      });
    }
  }
  return kind;
}

Kind learns() {
  return kind_of("learns", {Learns::all, Learns::beyond_nee},
                 [](RenderSettings& s) -> Learns& { return s.rl.learns; });
}

// From values to directions, and when.
Kind shaping() {
  return {"shaping",
          {[](RenderSettings&) {},
           [](RenderSettings& s) {
             s.rl.bin_weight = BinWeight::value_cosine;
             s.rl.shrinkage = 4;
           },
           [](RenderSettings& s) {
             s.rl.mixture = Mixture::learned;
             s.rl.update_growth = 0.5;
           },
           [](RenderSettings& s) {
             s.rl.bin_weight = BinWeight::value_cosine;
             s.rl.shrinkage = 1;
             s.rl.mixture = Mixture::learned;
             s.rl.teach_frames = 4;
             s.rl.guided_bounces = 1;
           }}};
}

Kind roulette() {
  Kind kind{"roulette", {}};
  for (const Roulette by : {Roulette::throughput, Roulette::reflectance, Roulette::value}) {
    kind.choices.push_back([by](RenderSettings& s) {
      s.rl.roulette = by;
      s.rl.roulette_scale = 1;
      s.russian_roulette_start = 0;
    });
  }
  return kind;
}

std::vector<Kind> kinds() {
  using U = UpdateRule;
  using L = LearningRate;
  using I = InitialTable;
  return {kind_of("update", {U::expected_sarsa, U::sarsa, U::q_learning, U::monte_carlo, U::paper_listing},
                  [](RenderSettings& s) -> U& { return s.rl.update; }),
          kind_of("rate", {L::visits_per_bin, L::visits_per_cell, L::constant, L::power},
                  [](RenderSettings& s) -> L& { return s.rl.learning_rate; }),
          states(),
          kind_of("initial", {I::zero, I::constant, I::random, I::cosine},
                  [](RenderSettings& s) -> I& { return s.rl.initial_table; }),
          direct_light(),
          learns(),
          shaping(),
          roulette(),
          kind_of("bins", {BinMap::cylindrical, BinMap::concentric},
                  [](RenderSettings& s) -> BinMap& { return s.rl.bin_map; })};
}

using Row = std::vector<std::size_t>;                                         // a choice of each kind
using Pair = std::tuple<std::size_t, std::size_t, std::size_t, std::size_t>;  // kind, choice, kind, choice

std::vector<Pair> pairs_of(const Row& row) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < row.size(); ++i) {
    for (std::size_t j = i + 1; j < row.size(); ++j) pairs.emplace_back(i, row[i], j, row[j]);
  }
  return pairs;
}

std::set<Pair> all_pairs(const std::vector<Kind>& kinds) {
  std::set<Pair> pairs;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    for (std::size_t j = i + 1; j < kinds.size(); ++j) {
      for (std::size_t a = 0; a < kinds[i].choices.size(); ++a) {
        for (std::size_t b = 0; b < kinds[j].choices.size(); ++b) pairs.emplace(i, a, j, b);
      }
    }
  }
  return pairs;
}

// Greedy: of many random rows the one that covers most of what is left (after Cohen et al. 1997, "The AETG
// System").
std::vector<Row> covering_rows(const std::vector<Kind>& kinds) {
  constexpr int kCandidates = 300;
  std::mt19937 random(1);
  std::set<Pair> left = all_pairs(kinds);
  std::vector<Row> rows;
  while (!left.empty()) {
    Row best;
    std::size_t most = 0;
    for (int i = 0; i < kCandidates; ++i) {
      Row row;
      for (const Kind& kind : kinds) row.push_back(random() % kind.choices.size());
      // Each row covers at least one pair that is left.
      const auto& [i1, c1, i2, c2] = *left.begin();
      row[i1] = c1;
      row[i2] = c2;
      std::size_t covered = 0;
      for (const Pair& pair : pairs_of(row)) covered += left.count(pair);
      if (covered > most) {
        most = covered;
        best = row;
      }
    }
    for (const Pair& pair : pairs_of(best)) left.erase(pair);
    rows.push_back(best);
  }
  return rows;
}

constexpr int kFrames = 48;

RenderSettings unguided(std::uint32_t seed) {
  RenderSettings settings = base_settings(seed);
  settings.environment = {0.3, 0.2, 0.1};
  settings.max_bounces = 3;
  settings.sampler = Sampler::bsdf;
  settings.nee = Nee::one_ray;
  return settings;
}

TEST(Covering, EveryPairOfChoicesEstimatesTheSameImage) {
  const Scene scene = glossy_room();
  const Rendering truth = render(scene, unguided(900), 4 * kFrames);
  const std::vector<Kind> all = kinds();
  const std::vector<Row> rows = covering_rows(all);
  RecordProperty("renders", static_cast<int>(rows.size()));
  std::uint32_t seed = 1;
  for (const Row& row : rows) {
    RenderSettings settings = unguided(seed++);
    settings.sampler = Sampler::rl;
    std::string name;
    for (std::size_t i = 0; i < row.size(); ++i) {
      all[i].choices[row[i]](settings);
      name += all[i].name + " " + std::to_string(row[i]) + ", ";
    }
    SCOPED_TRACE(name);
    expect_same_image(render(scene, settings, kFrames), truth, rows.size() * kBlocks);
  }
}

// Lights learned beside samplers that learn nothing.
TEST(Covering, LearnedLightsOfUnguidedPathsEstimateTheSameImage) {
  const Scene scene = glossy_room();
  const Rendering truth = render(scene, unguided(900), 4 * kFrames);
  std::uint32_t seed = 50;
  for (const Sampler sampler : {Sampler::bsdf, Sampler::uniform}) {
    for (const Nee nee : {Nee::one_ray, Nee::two_ray}) {
      SCOPED_TRACE(testing::Message() << enum_name(sampler) << ", " << enum_name(nee));
      RenderSettings settings = unguided(seed++);
      settings.sampler = sampler;
      settings.nee = nee;
      settings.lights = LightChoice::learned;
      settings.light_floor = 0.01;
      expect_same_image(render(scene, settings, kFrames), truth, 4 * kBlocks);
    }
  }
}

// A wide light above a floor and one of a hundred times its power below: learned choices are far from those
// by power, so that a weight with the wrong one of the two would count light twice or lose it.
TEST(Covering, LightsLearnedAgainstTheirPowerKeepTheMean) {
  LitFloor lit = lit_floor(0.8F, 2, 4, 1);
  lit.scene.materials.push_back(lambert(glm::vec3(0), glm::vec3(200)));
  add_quad(lit.scene, {-2, -1, -2}, {4, 0, 0}, {0, 0, 4},
           static_cast<std::uint32_t>(lit.scene.materials.size() - 1));
  RenderSettings settings = unguided(900);
  settings.environment = {0, 0, 0};
  settings.max_bounces = 1;
  settings.nee = Nee::none;
  const Rendering truth = render(lit.scene, settings, 256);
  settings.lights = LightChoice::learned;
  for (const Nee nee : {Nee::one_ray, Nee::two_ray}) {
    for (const Sampler sampler : {Sampler::bsdf, Sampler::rl}) {
      SCOPED_TRACE(testing::Message() << enum_name(sampler) << ", " << enum_name(nee));
      settings.nee = nee;
      settings.sampler = sampler;
      ++settings.seed;
      expect_same_image(render(lit.scene, settings, 64), truth, 4 * kBlocks);
    }
  }
}

}  // namespace
}  // namespace qtrace::test
