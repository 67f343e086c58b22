#include "tests/bench/limit_bench.h"

#include "engine/accel/build_bvh.h"
#include "engine/device_scene/scene_buffers.h"
#include "experiments/files/atomic_file.h"
#include "experiments/files/csv.h"
#include "experiments/files/text_table.h"
#include "tests/bench/embree.h"
#include "tests/bench/limit_shaders.h"
#include "tests/bench/ray_shader.h"
#include "tests/bench/rounds.h"
#include "tests/bench/scenes.h"

#include <cstdio>

namespace qtrace::bench {
namespace {

// Of a node with two children and of a triangle, counted in wide_nodes.glsl and intersect.glsl: coordinates
// unpacked, converted, multiplied and added; minima and maxima; the choice of the next link and the stack.
// Instructions of one lane, each as dear as a multiply-add: less there cannot be, divergence comes on top.
constexpr double kNodeOperations = 62;
constexpr double kTriangleOperations = 45;
constexpr double kNodeElements = 2;  // of 16 bytes
constexpr double kTriangleElements = 3;
constexpr double kRayBytes = sizeof(BenchRay) + sizeof(Answer);
constexpr double kGiga = 1e9;

struct Row {
  std::string scene;
  std::string kind;
  std::size_t rays;
  double nodes;  // of a ray
  double triangles;
  Spread mrays_per_s;
  Spread operations_limit;  // 10^9 a second
  Spread elements_limit;
  Spread bytes_limit;
  Spread operations_share;  // of the limit
  Spread elements_share;
  Spread bytes_share;
};

const std::vector<experiments::Column<Row>>& columns() {
  static const std::vector<experiments::Column<Row>> all{
      {"scene", [](const Row& r) { return r.scene; }},
      {"kind", [](const Row& r) { return r.kind; }},
      {"rays", [](const Row& r) { return std::uint64_t{r.rays}; }},
      {"nodes_per_ray", [](const Row& r) { return r.nodes; }},
      {"triangles_per_ray", [](const Row& r) { return r.triangles; }},
      {"mrays_per_s", [](const Row& r) { return r.mrays_per_s.median; }},
      {"mrays_per_s_low", [](const Row& r) { return r.mrays_per_s.low; }},
      {"mrays_per_s_high", [](const Row& r) { return r.mrays_per_s.high; }},
      {"limit_goperations_per_s", [](const Row& r) { return r.operations_limit.median; }},
      {"limit_gfetches_per_s", [](const Row& r) { return r.elements_limit.median; }},
      {"limit_gbytes_per_s", [](const Row& r) { return r.bytes_limit.median; }},
      {"arithmetic_share", [](const Row& r) { return r.operations_share.median; }},
      {"fetch_share", [](const Row& r) { return r.elements_share.median; }},
      {"memory_share", [](const Row& r) { return r.bytes_share.median; }},
  };
  return all;
}

void print(const std::vector<Row>& rows) {
  std::vector<std::vector<std::string>> cells;
  const auto percent = [](const Spread& share) { return fmt::format("{:.0f}", 100 * share.median); };
  for (const Row& r : rows) {
    cells.push_back({r.scene, r.kind, fmt::format("{:.1f}", r.nodes), fmt::format("{:.1f}", r.triangles),
                     text_of(r.mrays_per_s), percent(r.operations_share), percent(r.elements_share),
                     percent(r.bytes_share)});
  }
  fmt::print("\n{}\n", experiments::markdown_table({"scene", "rays", "nodes a ray", "triangles", "Mrays/s",
                                                    "% of arithmetic", "of fetches", "of memory"},
                                                   cells, 2));
  std::fflush(stdout);
}

// Of one ray, `member` of WalkSteps in intersect.glsl.
double mean_steps(const RayBuffers& buffers, bool occlusion, const std::string& member) {
  RayShader(occlusion, {{"COUNTED", member}}).trace(buffers);
  double sum = 0;
  const std::vector<Answer> counts = buffers.answers();
  for (const Answer& count : counts) sum += double{count.t};
  return sum / static_cast<double>(counts.size());
}

enum Measured : std::size_t { rays, arithmetic, fetches, memory };

// One scene with its rays.
class SceneLimits {
 public:
  SceneLimits(const gpu::Context& context, const RayBenchOptions& options, const std::string& name)
      : context_(context),
        options_(options),
        scene_(bench_scene(name)),
        name_(shown_name(name, scene_)),
        bvh_(build_bvh(scene_, BvhKind::sah)),
        buffers_(scene_, bvh_),
        sets_(make_rays(scene_, EmbreeScene(scene_, options.threads), options.size)),
        fetches_(bvh_.nodes.size() / 2) {}  // the other nodes are leaves

  void run(RayKind kind, std::vector<Row>& rows, std::vector<RoundRow>& rounds) const {
    if (sets_.of(kind).empty()) return;
    buffers_.bind();
    const RayBuffers asked(sets_.of(kind));
    const bool occlusion = kind == RayKind::shadow;
    const RayShader query(occlusion, {});
    std::vector<Contender> measured{{"rays", timing([&] { query.trace(asked); })},
                                    {"arithmetic", timing([&] { arithmetic_.run(); })},
                                    {"fetches", timing([&] { fetches_.run(); })},
                                    {"memory", timing([&] { memory_.run(); })}};
    run_rounds(measured, options_.rounds);
    const std::string kind_name(kRayKinds[static_cast<std::size_t>(kind)]);
    rows.push_back(row_of(kind_name, sets_.of(kind).size(), mean_steps(asked, occlusion, "nodes"),
                          mean_steps(asked, occlusion, "triangles"), measured));
    for (const Contender& c : measured) append_rounds(rounds, {name_, kind_name, c.name}, c);
  }

 private:
  template <class Run>
  std::function<Duration()> timing(Run run) const {
    return [this, run] { return timed(run, [this] { context_.finish(); }); };
  }

  Row row_of(const std::string& kind, std::size_t count, double nodes, double triangles,
             const std::vector<Contender>& measured) const {
    const auto amount = static_cast<double>(count);
    const auto rate = [&](Measured what, double of) { return rate_of(of, measured[what].wall_s); };
    const auto share = [&](Measured limit, double needed, double done) {
      return amount * needed / done * ratio_of(measured[limit].wall_s, measured[rays].wall_s);
    };
    return {name_,
            kind,
            count,
            nodes,
            triangles,
            1e-6 * rate(rays, amount),
            1 / kGiga * rate(arithmetic, ArithmeticLimit::operations()),
            1 / kGiga * rate(fetches, FetchLimit::elements()),
            1 / kGiga * rate(memory, MemoryLimit::bytes()),
            share(arithmetic, nodes * kNodeOperations + triangles * kTriangleOperations,
                  ArithmeticLimit::operations()),
            share(fetches, nodes * kNodeElements + triangles * kTriangleElements, FetchLimit::elements()),
            share(memory, kRayBytes, MemoryLimit::bytes())};
  }

  const gpu::Context& context_;
  const RayBenchOptions& options_;
  Scene scene_;
  std::string name_;
  Bvh bvh_;
  gpu::SceneBuffers buffers_;
  RaySets sets_;
  ArithmeticLimit arithmetic_;
  FetchLimit fetches_;
  MemoryLimit memory_;
};

}  // namespace

void bench_limits(const gpu::Context& context, const RayBenchOptions& options) {
  std::vector<Row> rows;
  std::vector<RoundRow> rounds;
  for (const std::string& name : options.scenes) {
    const SceneLimits scene(context, options, name);
    for (const RayKind kind : {RayKind::primary, RayKind::bounce, RayKind::shadow})
      scene.run(kind, rows, rounds);
  }
  print(rows);
  experiments::write_file(options.out / "limits.csv", experiments::csv_text(columns(), rows));
  experiments::write_file(options.out / "limit_rounds.csv",
                          rounds_csv({"scene", "kind", "measured"}, rounds));
}

}  // namespace qtrace::bench
