#include "tests/bench/ray_bench.h"

#include "engine/gpu/scene_buffers.h"
#include "experiments/atomic_file.h"
#include "experiments/csv.h"
#include "experiments/text_table.h"
#include "tests/bench/embree.h"
#include "tests/bench/ray_shader.h"
#include "tests/bench/scenes.h"
#include "tests/bench/timing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

namespace qtrace::bench {
namespace {

// t may differ by this part of itself, and by this length of a scene's size: what single precision leaves of
// a hit on either side.
constexpr float kTolerance = 1e-3F;
constexpr int kDeviceWarmUps = 2;

// What is timed in one round, and what it said.
struct Contender {
  std::string name;
  std::function<void()> trace;
  std::function<std::vector<Answer>()> answers;
  std::vector<double> wall_s = {};
  std::vector<double> cpu_s = {};
  std::size_t disagreements = 0;  // with Embree
};

struct Row {
  std::string scene;
  std::size_t triangles;
  std::string kind;
  std::size_t rays;
  unsigned threads;
  Contender contender;
  Spread mrays_per_s;
  Spread speed;      // Embree's time over this one's, by the clock
  Spread cpu_speed;  // by processor time
};

struct RoundRow {
  std::string scene;
  std::string kind;
  std::string contender;
  std::size_t round;
  Duration time;
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

// Each round starts with another contender, so that none always follows the same one.
void run_rounds(std::vector<Contender>& contenders, int rounds) {
  for (int i = 0; i < kDeviceWarmUps; ++i) {
    for (const Contender& c : contenders) c.trace();
  }
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      Contender& c = contenders[(i + static_cast<std::size_t>(round)) % contenders.size()];
      const Duration time = timed(c.trace);
      c.wall_s.push_back(time.wall_s);
      c.cpu_s.push_back(time.cpu_s);
    }
  }
  const std::vector<Answer> truth = contenders.front().answers();
  for (Contender& c : contenders) c.disagreements = count_disagreements(truth, c.answers());
}

class SceneBench {
 public:
  SceneBench(const gpu::Context& context, const RayBenchOptions& options, const std::string& name)
      : context_(context),
        options_(options),
        name_(name),
        scene_(bench_scene(name)),
        embree_(scene_, options.threads),
        rays_(make_rays(scene_, embree_, options.size)),
        ordered_(scene_, build_bvh(scene_, BvhKind::sah)),
        threaded_(scene_, build_bvh(scene_, BvhKind::threaded)) {
    fmt::print("{}: {} triangles; Embree builds in {:.2f} s\n", name, scene_.triangles.size(),
               embree_.build_s());
    std::fflush(stdout);
  }

  void run(RayKind kind, std::vector<Row>& rows, std::vector<RoundRow>& rounds) const {
    const std::vector<BenchRay>& rays = rays_.of(kind);
    if (rays.empty()) return;
    const RayBuffers device_rays(rays);
    std::vector<Answer> answers;
    std::vector<Contender> contenders{embree_contender(kind, answers)};
    for (const Variant& variant : options_.variants) {
      auto shader = std::make_shared<RayShader>(kind == RayKind::shadow, variant.defines);
      contenders.push_back({variant.name,
                            [=, this, &device_rays, &variant] {
                              buffers_of(variant).bind();
                              shader->trace(context_, device_rays);
                            },
                            [=, this, &device_rays, &variant] {
                              buffers_of(variant).bind();
                              shader->trace(context_, device_rays);
                              return device_rays.answers();
                            }});
    }
    run_rounds(contenders, options_.rounds);
    const std::string kind_name(kRayKinds[static_cast<std::size_t>(kind)]);
    for (const Contender& c : contenders) {
      rows.push_back(row_of(kind_name, rays.size(), c, contenders.front()));
      for (std::size_t i = 0; i < c.wall_s.size(); ++i) {
        rounds.push_back({name_, kind_name, c.name, i + 1, {c.wall_s[i], c.cpu_s[i]}});
      }
    }
  }

 private:
  const gpu::SceneBuffers& buffers_of(const Variant& variant) const {
    const auto bvh = variant.defines.find("BVH");
    return bvh != variant.defines.end() && bvh->second == "1" ? threaded_ : ordered_;
  }

  Contender embree_contender(RayKind kind, std::vector<Answer>& answers) const {
    const std::vector<BenchRay>& rays = rays_.of(kind);
    if (kind == RayKind::shadow)
      return {"Embree", [&] { embree_.occlusions(rays, answers); }, [&] { return answers; }};
    return {"Embree", [&] { embree_.closest_hits(rays, answers); }, [&] { return answers; }};
  }

  Row row_of(const std::string& kind, std::size_t rays, const Contender& c, const Contender& embree) const {
    std::vector<double> speeds;
    for (const double seconds : c.wall_s) speeds.push_back(1e-6 * static_cast<double>(rays) / seconds);
    return {name_,
            scene_.triangles.size(),
            kind,
            rays,
            options_.threads,
            c,
            spread_of(speeds),
            ratio_of(embree.wall_s, c.wall_s),
            ratio_of(embree.cpu_s, c.cpu_s)};
  }

  const gpu::Context& context_;
  const RayBenchOptions& options_;
  std::string name_;
  Scene scene_;
  EmbreeScene embree_;
  RaySets rays_;
  gpu::SceneBuffers ordered_;
  gpu::SceneBuffers threaded_;
};

const std::vector<experiments::Column<Row>>& columns() {
  static const std::vector<experiments::Column<Row>> all{
      {"scene", [](const Row& r) { return r.scene; }},
      {"triangles", [](const Row& r) { return std::uint64_t{r.triangles}; }},
      {"kind", [](const Row& r) { return r.kind; }},
      {"rays", [](const Row& r) { return std::uint64_t{r.rays}; }},
      {"tracer", [](const Row& r) { return r.contender.name; }},
      {"embree_threads", [](const Row& r) { return std::uint64_t{r.threads}; }},
      {"rounds", [](const Row& r) { return std::uint64_t{r.contender.wall_s.size()}; }},
      {"mrays_per_s", [](const Row& r) { return r.mrays_per_s.median; }},
      {"mrays_per_s_low", [](const Row& r) { return r.mrays_per_s.low; }},
      {"mrays_per_s_high", [](const Row& r) { return r.mrays_per_s.high; }},
      {"speed_over_embree", [](const Row& r) { return r.speed.median; }},
      {"speed_over_embree_low", [](const Row& r) { return r.speed.low; }},
      {"speed_over_embree_high", [](const Row& r) { return r.speed.high; }},
      {"cpu_speed_over_embree", [](const Row& r) { return r.cpu_speed.median; }},
      {"cpu_speed_over_embree_low", [](const Row& r) { return r.cpu_speed.low; }},
      {"cpu_speed_over_embree_high", [](const Row& r) { return r.cpu_speed.high; }},
      {"disagreements", [](const Row& r) { return std::uint64_t{r.contender.disagreements}; }},
  };
  return all;
}

const std::vector<experiments::Column<RoundRow>>& round_columns() {
  static const std::vector<experiments::Column<RoundRow>> all{
      {"scene", [](const RoundRow& r) { return r.scene; }},
      {"kind", [](const RoundRow& r) { return r.kind; }},
      {"tracer", [](const RoundRow& r) { return r.contender; }},
      {"round", [](const RoundRow& r) { return std::uint64_t{r.round}; }},
      {"wall_s", [](const RoundRow& r) { return r.time.wall_s; }},
      {"cpu_s", [](const RoundRow& r) { return r.time.cpu_s; }},
  };
  return all;
}

std::string spread_text(const Spread& s) {
  return fmt::format("{:.3g} [{:.3g}, {:.3g}]", s.median, s.low, s.high);
}

void print(const std::vector<Row>& rows) {
  std::vector<std::vector<std::string>> cells;
  for (const Row& r : rows) {
    cells.push_back({r.scene, r.kind, r.contender.name, spread_text(r.mrays_per_s), spread_text(r.speed),
                     spread_text(r.cpu_speed), fmt::format("{} of {}", r.contender.disagreements, r.rays)});
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
  experiments::write_file(options.out / "ray_rounds.csv", experiments::csv_text(round_columns(), rounds));
}

}  // namespace qtrace::bench
