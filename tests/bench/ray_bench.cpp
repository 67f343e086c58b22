#include "tests/bench/ray_bench.h"

#include "engine/accel/build_bvh.h"
#include "engine/device_scene/scene_buffers.h"
#include "experiments/files/atomic_file.h"
#include "experiments/files/csv.h"
#include "experiments/files/text_table.h"
#include "tests/bench/embree.h"
#include "tests/bench/ray_shader.h"
#include "tests/bench/rounds.h"
#include "tests/bench/scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace qtrace::bench {
namespace {

// t may differ by this part of itself, and by this length of a scene's size: what single precision leaves of
// a hit on either side.
constexpr float kTolerance = 1e-3F;

struct Row {
  std::string scene;
  std::size_t triangles;
  std::string kind;
  std::size_t rays;
  unsigned threads;
  std::string tracer;
  std::size_t rounds;
  double build_s;             // of its hierarchy, on the host
  std::size_t disagreements;  // with Embree
  Spread mrays_per_s;
  Spread speed;      // Embree's time over this one's, by the clock
  Spread cpu_speed;  // by processor time
};

std::size_t count_disagreements(const std::vector<Answer>& a, const std::vector<Answer>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool both_hit = std::isfinite(a[i].t) && std::isfinite(b[i].t);
    const bool agree = both_hit ? std::abs(a[i].t - b[i].t) <= kTolerance * std::max(a[i].t, b[i].t)
                                : std::isfinite(a[i].t) == std::isfinite(b[i].t);
    count += agree ? 0 : 1;
  }
  return count;
}

class SceneBench {
 public:
  SceneBench(const gpu::Context& context, const RayBenchOptions& options, const std::string& name)
      : context_(context),
        options_(options),
        scene_(bench_scene(name)),
        name_(shown_name(name, scene_)),
        embree_(scene_, options.threads),
        rays_(make_rays(scene_, embree_, options.size)) {
    fmt::print("{}: {} triangles; built by Embree in {:.3g} s", name_, scene_.triangles.size(),
               embree_.build_s());
    for (const Variant& variant : options.variants) build(bvh_of(variant));
    fmt::print("\n");
    std::fflush(stdout);
  }

  void run(RayKind kind, std::vector<Row>& rows, std::vector<RoundRow>& rounds) const {
    const std::vector<BenchRay>& rays = rays_.of(kind);
    if (rays.empty()) return;
    // Answers of each apart: what is compared in the end is what the last round was timed at.
    std::vector<Answer> truth;
    std::vector<RayBuffers> asked;
    const std::vector<RayShader> shaders = shaders_of(kind);
    std::vector<Contender> contenders{
        {"Embree", [&] { return timed([&] { ask_embree(kind, truth); }, [] {}); }}};
    for (std::size_t i = 0; i < shaders.size(); ++i) {
      asked.emplace_back(rays);
      contenders.push_back({options_.variants[i].name, [&, i] {
                              buffers_of(options_.variants[i]).bind();
                              return timed([&] { shaders[i].trace(asked[i]); }, [&] { context_.finish(); });
                            }});
    }
    run_rounds(contenders, options_.rounds);
    const std::string kind_name(kRayKinds[static_cast<std::size_t>(kind)]);
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      std::size_t disagreements = 0;
      double build_s = embree_.build_s();
      if (i > 0) {
        build_s = build_s_.at(bvh_of(options_.variants[i - 1]));
        disagreements = count_disagreements(truth, asked[i - 1].answers());
      }
      rows.push_back(
          row_of(kind_name, rays.size(), contenders[i], contenders.front(), build_s, disagreements));
      append_rounds(rounds, {name_, kind_name, contenders[i].name}, contenders[i]);
    }
  }

 private:
  // By the variant's define, as in shaders/shared/variants.glsl.
  static BvhKind bvh_of(const Variant& variant) {
    const auto kind = variant.defines.find("BVH");
    return kind != variant.defines.end() && kind->second == "1" ? BvhKind::threaded : BvhKind::sah;
  }

  const gpu::SceneBuffers& buffers_of(const Variant& variant) const { return buffers_.at(bvh_of(variant)); }

  void build(BvhKind kind) {
    if (buffers_.contains(kind)) return;
    Bvh bvh;
    build_s_[kind] = timed([&] { bvh = build_bvh(scene_, kind); }, [] {}).wall_s;
    buffers_.try_emplace(kind, scene_, bvh);
    fmt::print(", {} in {:.3g} s", enum_name(kind), build_s_[kind]);
  }

  std::vector<RayShader> shaders_of(RayKind kind) const {
    std::vector<RayShader> shaders;
    for (const Variant& variant : options_.variants) {
      shaders.emplace_back(kind == RayKind::shadow, variant.defines);
    }
    return shaders;
  }

  void ask_embree(RayKind kind, std::vector<Answer>& answers) const {
    if (kind == RayKind::shadow)
      embree_.occlusions(rays_.of(kind), answers);
    else
      embree_.closest_hits(rays_.of(kind), answers);
  }

  Row row_of(const std::string& kind, std::size_t rays, const Contender& c, const Contender& embree,
             double build_s, std::size_t disagreements) const {
    return {name_,
            scene_.triangles.size(),
            kind,
            rays,
            options_.threads,
            c.name,
            c.wall_s.size(),
            build_s,
            disagreements,
            1e-6 * rate_of(static_cast<double>(rays), c.wall_s),
            ratio_of(embree.wall_s, c.wall_s),
            ratio_of(embree.cpu_s, c.cpu_s)};
  }

  const gpu::Context& context_;
  const RayBenchOptions& options_;
  Scene scene_;
  std::string name_;
  EmbreeScene embree_;
  RaySets rays_;
  std::map<BvhKind, gpu::SceneBuffers> buffers_;
  std::map<BvhKind, double> build_s_;
};

const std::vector<experiments::Column<Row>>& columns() {
  static const std::vector<experiments::Column<Row>> all{
      {"scene", [](const Row& r) { return r.scene; }},
      {"triangles", [](const Row& r) { return std::uint64_t{r.triangles}; }},
      {"kind", [](const Row& r) { return r.kind; }},
      {"rays", [](const Row& r) { return std::uint64_t{r.rays}; }},
      {"tracer", [](const Row& r) { return r.tracer; }},
      {"embree_threads", [](const Row& r) { return std::uint64_t{r.threads}; }},
      {"rounds", [](const Row& r) { return std::uint64_t{r.rounds}; }},
      {"build_s", [](const Row& r) { return r.build_s; }},
      {"mrays_per_s", [](const Row& r) { return r.mrays_per_s.median; }},
      {"mrays_per_s_low", [](const Row& r) { return r.mrays_per_s.low; }},
      {"mrays_per_s_high", [](const Row& r) { return r.mrays_per_s.high; }},
      {"speed_over_embree", [](const Row& r) { return r.speed.median; }},
      {"speed_over_embree_low", [](const Row& r) { return r.speed.low; }},
      {"speed_over_embree_high", [](const Row& r) { return r.speed.high; }},
      {"cpu_speed_over_embree", [](const Row& r) { return r.cpu_speed.median; }},
      {"cpu_speed_over_embree_low", [](const Row& r) { return r.cpu_speed.low; }},
      {"cpu_speed_over_embree_high", [](const Row& r) { return r.cpu_speed.high; }},
      {"disagreements", [](const Row& r) { return std::uint64_t{r.disagreements}; }},
  };
  return all;
}

void print(const std::vector<Row>& rows) {
  std::vector<std::vector<std::string>> cells;
  for (const Row& r : rows) {
    cells.push_back({r.scene, r.kind, r.tracer, text_of(r.mrays_per_s), text_of(r.speed),
                     text_of(r.cpu_speed), fmt::format("{} of {}", r.disagreements, r.rays)});
  }
  fmt::print("\n{}\n",
             experiments::markdown_table(
                 {"scene", "rays", "tracer", "Mrays/s", "over Embree", "by CPU time", "disagree"}, cells, 3));
}

}  // namespace

void bench_rays(const gpu::Context& context, const RayBenchOptions& options) {
  std::vector<Row> rows;
  std::vector<RoundRow> rounds;
  for (const std::string& name : options.scenes) {
    const SceneBench bench(context, options, name);
    for (const RayKind kind : {RayKind::primary, RayKind::bounce, RayKind::shadow}) {
      bench.run(kind, rows, rounds);
    }
  }
  print(rows);
  experiments::write_file(options.out / "rays.csv", experiments::csv_text(columns(), rows));
  experiments::write_file(options.out / "ray_rounds.csv", rounds_csv({"scene", "kind", "tracer"}, rounds));
}

}  // namespace qtrace::bench
