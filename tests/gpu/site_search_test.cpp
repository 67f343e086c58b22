// The searches through lists and through trees of sites find what a search through all sites finds, index for
// index.
#include "engine/core/check.h"
#include "engine/scene/analytic.h"
#include "engine/gltf/load_gltf.h"
#include "engine/tracer/cell_buffers.h"
#include "engine/tracer/limits.h"
#include "engine/tracer/shader_variant.h"
#include "tests/support/probe.h"
#include "tests/support/goswami.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace qtrace::test {
namespace {

constexpr std::uint32_t kQueries = 1 << 15;  // of every arrangement and threshold
constexpr float kThresholds[] = {-1.0F, 0.5F, 0.866F, 0.99F};

struct Query {
  glm::vec4 position;  // w: bits of the object
  glm::vec4 normal;
};

class Queries {
 public:
  Queries(const CellSites& cells, std::uint32_t seed) : cells_(cells), random_(seed) {
    lo_ = glm::vec3(std::numeric_limits<float>::infinity());
    hi_ = -lo_;
    for (const CellSite& s : cells.sites) {
      lo_ = glm::min(lo_, s.position);
      hi_ = glm::max(hi_, s.position);
    }
  }

  std::vector<Query> take(std::uint32_t count) {
    std::vector<Query> queries(count);
    for (Query& q : queries) {
      const auto object = static_cast<std::uint32_t>(random_() % (cells_.first.size() - 1));
      const CellSite& a = site_of(object);
      const CellSite& b = site_of(object);
      q.position = glm::vec4(near(a.position, b.position), std::bit_cast<float>(object));
      q.normal = glm::vec4(tilt(a.normal, b.normal), 0);
    }
    return queries;
  }

 private:
  const CellSite& site_of(std::uint32_t object) {
    const std::size_t count = cells_.first[object + 1] - cells_.first[object];
    return count > 0 ? cells_.sites[cells_.first[object] + random_() % count]
                     : cells_.sites[random_() % cells_.sites.size()];
  }

  glm::vec3 noise() { return {gauss_(random_), gauss_(random_), gauss_(random_)}; }

  // At a site, halfway between two, beside one, or anywhere about the box.
  glm::vec3 near(glm::vec3 a, glm::vec3 b) {
    const float size = glm::length(hi_ - lo_);
    switch (random_() % 4) {
      case 0:
        return a;
      case 1:
        return 0.5F * (a + b);
      case 2:
        return a + 0.03F * size * noise();
      default:
        return 0.5F * (lo_ + hi_) + 0.5F * size * noise();
    }
  }

  glm::vec3 tilt(glm::vec3 a, glm::vec3 b) {
    const glm::vec3 choices[] = {a, a + b, a + 0.2F * noise(), noise()};
    const glm::vec3 chosen = choices[random_() % 4];
    return glm::length(chosen) > 1e-3F ? glm::normalize(chosen) : a;
  }

  const CellSites& cells_;
  std::mt19937 random_;
  std::normal_distribution<float> gauss_;
  glm::vec3 lo_, hi_;
};

std::vector<glm::uvec4> search(const std::vector<Query>& queries, SiteSearch how,
                               const gpu::Defines& more = {}) {
  const gpu::Buffer input("queries", queries);
  input.bind_storage(gpu::BINDING_SAMPLES);
  RenderSettings settings;
  settings.rl = goswami_table();
  settings.rl.site_search = how;
  gpu::Defines defines = shader_defines(settings, {});
  defines.insert(more.begin(), more.end());
  return probe<glm::uvec4>(
      "uvec4", {"shared/variants.glsl", "learning/cells.glsl"},
      "struct Query { vec4 position; vec4 normal; };\n"
      "layout(std430, binding = BINDING_SAMPLES) readonly buffer QueryBuffer { Query queries[]; };",
      "Surface s;\n"
      "s.position = queries[index].position.xyz;\n"
      "s.object = floatBitsToUint(queries[index].position.w);\n"
      "s.mesh_normal = s.normal = queries[index].normal.xyz;\n"
      "s.back = false;\n"
      "result = uvec4(uint(find_cell(s).index), loop_was_cut ? 1u : 0u, 0u, 0u);\n"
      "#if SITE_SEARCH == SITE_SEARCH_LISTS\n"
      "result.z = (list_entry(s, range_of(s.object)) & ((1u << LIST_COUNT_BITS) - 1u)) != 0u ? 1u : 0u;\n"
      "#endif",
      static_cast<std::uint32_t>(queries.size()), defines);
}

// Parameters that the search reads, for as long as it is bound.
gpu::Buffer bind_threshold(double threshold) {
  device();
  gpu::Parameters parameters{};
  parameters.cell_normal_threshold = static_cast<float>(threshold);
  gpu::Buffer block("parameters", sizeof(gpu::Parameters));
  block.write(0, &parameters, sizeof(parameters));
  block.bind_uniform(gpu::BINDING_PARAMETERS);
  return block;
}

std::size_t count_differences(const std::vector<glm::uvec4>& found, const std::vector<glm::uvec4>& truth) {
  std::size_t differences = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i].x != truth[i].x || found[i].y != 0) ++differences;
  }
  return differences;
}

void expect_same_cells(const CellSites& cells) {
  for (const float threshold : kThresholds) {
    SCOPED_TRACE(testing::Message() << "threshold " << threshold);
    const gpu::Buffer block = bind_threshold(threshold);
    const CellBuffers buffers(cells);
    buffers.bind();
    const std::vector<Query> queries = Queries(cells, 11).take(kQueries);
    EXPECT_EQ(count_differences(search(queries, SiteSearch::tree), search(queries, SiteSearch::linear)), 0U)
        << "of " << kQueries;
  }
}

// Points of the surfaces, a third of them on edges and corners, with interpolated normals and those of faces:
// what paths ask for.
std::vector<Query> surface_queries(const Scene& scene, std::uint32_t count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform;
  std::vector<double> areas;
  for (const Triangle& t : scene.triangles) areas.push_back(area_of(t));
  std::discrete_distribution<std::size_t> by_area(areas.begin(), areas.end());
  std::vector<Query> queries(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    Query& q = queries[i];
    const Triangle& t = scene.triangles[i % 2 == 1 ? by_area(random) : random() % scene.triangles.size()];
    float u = uniform(random);
    float v = uniform(random);
    if (random() % 3 == 0) u = std::round(u);
    if (u + v > 1) v = u > v ? 1 - u : v, u = std::min(u, 1 - v);
    const glm::vec3 blend = (1 - u - v) * t.normal[0] + u * t.normal[1] + v * t.normal[2];
    const glm::vec3 face(glm::normalize(area_vector(t.position)));
    q.position =
        glm::vec4(t.position[0] + u * (t.position[1] - t.position[0]) + v * (t.position[2] - t.position[0]),
                  std::bit_cast<float>(t.object));
    q.normal = glm::vec4(random() % 4 == 0 || glm::length(blend) < 1e-6F ? face : glm::normalize(blend), 0);
  }
  return queries;
}

struct Listed {
  double area = 0;  // part of the scene's where a list answers
  bool complete = false;
};

Listed expect_lists_agree(const Scene& scene, RlSettings settings) {
  constexpr std::uint32_t kSurfaceQueries = 1 << 17;
  const gpu::Buffer block = bind_threshold(settings.cell_normal_threshold);
  settings.site_search = SiteSearch::lists;
  const CellBuffers buffers(scene, settings);
  buffers.bind();
  const std::vector<Query> queries = surface_queries(scene, kSurfaceQueries);
  const auto lists = search(queries, SiteSearch::lists);
  const auto truth = search(queries, SiteSearch::linear);
  EXPECT_EQ(count_differences(lists, truth), 0U) << "of " << kSurfaceQueries;
  if (buffers.lists_are_complete()) {
    const auto alone = search(queries, SiteSearch::lists, with_cells({}, buffers));
    EXPECT_EQ(count_differences(alone, truth), 0U) << "without a tree, of " << kSurfaceQueries;
  }
  std::size_t listed = 0;
  for (std::uint32_t i = 1; i < kSurfaceQueries; i += 2) listed += lists[i].z;
  return {static_cast<double>(listed) / (kSurfaceQueries / 2), buffers.lists_are_complete()};
}

CellSites on_simple(SitePlacement placement, int sites) {
  RlSettings settings = goswami_table();
  settings.site_placement = placement;
  settings.sites_per_object = sites;
  return place_sites(load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/simple.glb"), settings);
}

// Whole coordinates, normals along the axes, and every site `copies` times: exact ties everywhere.
CellSites lattice(int side, int copies) {
  CellSites cells;
  for (int i = 0; i < side * side * side * copies; ++i) {
    const int cell = i / copies;
    glm::vec3 normal(0);
    normal[cell % 3] = cell % 2 == 0 ? 1.0F : -1.0F;
    cells.sites.push_back({glm::vec3(cell % side, cell / side % side, cell / side / side), normal});
  }
  std::ranges::shuffle(cells.sites, std::mt19937(2));
  cells.first = {0, static_cast<std::uint32_t>(cells.sites.size())};
  return cells;
}

// Objects of the given numbers of sites, at random places with random normals.
CellSites scattered(const std::vector<std::uint32_t>& counts) {
  std::mt19937 random(4);
  std::normal_distribution<float> gauss;
  const auto vector = [&] { return glm::vec3(gauss(random), gauss(random), gauss(random)); };
  CellSites cells;
  cells.first = {0};
  for (const std::uint32_t count : counts) {
    for (std::uint32_t i = 0; i < count; ++i) cells.sites.push_back({vector(), glm::normalize(vector())});
    cells.first.push_back(static_cast<std::uint32_t>(cells.sites.size()));
  }
  return cells;
}

TEST(SiteSearch, OnTheShippedScene) {
  for (const SitePlacement placement : {SitePlacement::uv, SitePlacement::area}) {
    SCOPED_TRACE(enum_name(placement));
    expect_same_cells(on_simple(placement, 100));
  }
  expect_same_cells(on_simple(SitePlacement::uv, 1500));
}

TEST(SiteSearch, WhereSitesTie) {
  for (const int copies : {1, 3}) {
    SCOPED_TRACE(testing::Message() << copies << " copies");
    expect_same_cells(lattice(6, copies));
  }
}

TEST(SiteSearch, OfEqualSites) {
  CellSites cells = scattered({1});
  cells.sites.resize(77, cells.sites[0]);
  cells.first = {0, 77};
  expect_same_cells(cells);
}

TEST(SiteSearch, OfFewSites) { expect_same_cells(scattered({0, 1, 2, 3, 0, 4, 5, 6, 7, 8, 9})); }

TEST(SiteSearch, AmongNormalsOfAllDirections) { expect_same_cells(scattered({300, 1000})); }

// More than a million queries in all.
TEST(SiteSearch, ThroughListsOnTheShippedScene) {
  const Scene scene = load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/simple.glb");
  for (const SitePlacement placement : {SitePlacement::uv, SitePlacement::area}) {
    for (const int sites : {10, 100, 1000}) {
      SCOPED_TRACE(testing::Message() << sites << " sites, " << enum_name(placement));
      RlSettings settings = goswami_table();
      settings.site_placement = placement;
      settings.sites_per_object = sites;
      const Listed listed = expect_lists_agree(scene, settings);
      EXPECT_GT(listed.area, 0.97);
      EXPECT_TRUE(listed.complete || sites > 100);
    }
  }
  for (const double threshold : {-1.0, 0.5, 0.99}) {
    SCOPED_TRACE(testing::Message() << "threshold " << threshold);
    RlSettings settings = goswami_table();
    settings.cell_normal_threshold = threshold;
    const Listed listed = expect_lists_agree(scene, settings);
    EXPECT_GT(listed.area, 0.97);
  }
}

// Six searches of 25,000 turns each would be cut; through the tree they are short.
TEST(SiteSearch, TooLongALinearSearchIsRefused) {
  if (device().device().loop_limit == 0)
    GTEST_SKIP() << "this driver cuts no loops";
  const Scene scene = lit_floor(0.8F, 10, 1, 1).scene;
  RenderSettings settings;
  settings.rl = goswami_table();
  settings.max_bounces = 5;
  settings.rl.sites_per_object = 100000;
  settings.rl.bins_theta = settings.rl.bins_phi = 2;
  EXPECT_NO_THROW(check_limits(device(), scene, settings));
  settings.rl.site_search = SiteSearch::linear;
  try {
    check_limits(device(), scene, settings);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("choose rl.site_search lists"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace qtrace::test
