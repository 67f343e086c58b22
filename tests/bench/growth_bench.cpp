#include "tests/bench/growth_bench.h"

#include "engine/core/check.h"
#include "experiments/files/atomic_file.h"
#include "experiments/files/csv.h"
#include "experiments/runtime/scene_store.h"
#include "experiments/files/text_table.h"
#include "tests/bench/frame_bench.h"
#include "tests/bench/rounds.h"
#include "tests/bench/scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <optional>

namespace qtrace::bench {
namespace {

// What grows: its values, and how each is set.
struct Axis {
  std::string name;
  std::vector<int> values;
  bool table_only;  // nothing for a path tracer without a table
  std::function<void(RenderSettings&, int)> apply;
};

void set_bins(RenderSettings& settings, int bins) {
  const auto side = static_cast<int>(std::lround(std::sqrt(bins)));
  settings.rl.bins_theta = settings.rl.bins_phi = side;
}

// As few bins as there can be, so that a table of so many cells fits the device.
void set_sites(RenderSettings& settings, int sites) {
  settings.rl.sites_per_object = sites;
  settings.rl.bins_theta = 2;
  settings.rl.bins_phi = 1;
}

// Without Russian roulette, which would end paths long before.
void set_bounces(RenderSettings& settings, int bounces) {
  settings.max_bounces = settings.russian_roulette_start = bounces;
}

const std::vector<Axis>& axes() {
  static const std::vector<Axis> all{
      {"triangles", {1000, 10'000, 100'000, 1'000'000, 5'000'000}, false, [](RenderSettings&, int) {}},
      {"sites per object", {10, 100, 1000, 10'000, 100'000}, true, set_sites},
      {"bins", {4, 16, 64, 256, 1024}, true, set_bins},
      {"bounces", {1, 2, 4, 8, 16, 32}, false, set_bounces},
      {"pixels",
       {64 * 64, 128 * 128, 256 * 256, 512 * 512, 1024 * 1024},
       false,
       [](RenderSettings& s, int pixels) {
         s.width = s.height = static_cast<int>(std::lround(std::sqrt(pixels)));
       }},
  };
  return all;
}

struct Row {
  std::string axis;
  double value;
  std::string method;
  std::uint64_t rays;
  Spread wall_ms;
  Spread over_first;
  Spread cpu_over_first;
};

const std::vector<experiments::Column<Row>>& columns() {
  static const std::vector<experiments::Column<Row>> all{
      {"axis", [](const Row& r) { return r.axis; }},
      {"value", [](const Row& r) { return r.value; }},
      {"method", [](const Row& r) { return r.method; }},
      {"rays", [](const Row& r) { return r.rays; }},
      {"wall_ms", [](const Row& r) { return r.wall_ms.median; }},
      {"wall_ms_low", [](const Row& r) { return r.wall_ms.low; }},
      {"wall_ms_high", [](const Row& r) { return r.wall_ms.high; }},
      {"over_first", [](const Row& r) { return r.over_first.median; }},
      {"over_first_low", [](const Row& r) { return r.over_first.low; }},
      {"over_first_high", [](const Row& r) { return r.over_first.high; }},
      {"cpu_over_first", [](const Row& r) { return r.cpu_over_first.median; }},
  };
  return all;
}

struct Method {
  std::string name;
  RenderSettings settings;
};

// Without next event estimation: the plain path tracer, and the learned one.
std::vector<Method> methods(const experiments::Experiment& experiment) {
  std::vector<Method> found;
  const std::string& scene = experiment.runs.front().config.scene;
  for (const experiments::Run& run : experiment.runs) {
    const RenderSettings& s = run.config.render;
    if (run.config.scene == scene && s.nee == Nee::none && s.sampler != Sampler::uniform) {
      found.push_back({run.labels.back(), s});
    }
  }
  return found;
}

struct Point {
  double value;
  std::string method;
  std::unique_ptr<Tracer> tracer;
};

class GrowthBench {
 public:
  GrowthBench(const gpu::Context& context, const GrowthBenchOptions& options)
      : context_(context), options_(options), experiment_(paper_table(options.size)) {}

  void run(const Axis& axis) {
    std::vector<Point> points = points_of(axis);
    std::vector<Contender> contenders;
    for (const Point& point : points) {
      contenders.push_back({point.method, [&] { return timed_frame(context_, *point.tracer); }});
    }
    run_rounds(contenders, options_.rounds);
    std::map<std::string, const Contender*> first;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Contender& c = contenders[i];
      const Contender& base = *first.emplace(c.name, &c).first->second;
      rows_.push_back({axis.name, points[i].value, c.name, points[i].tracer->last_frame_counters().rays,
                       kMilliseconds * spread_of(c.wall_s), ratio_of(c.wall_s, base.wall_s),
                       ratio_of(c.cpu_s, base.cpu_s)});
      append_rounds(rounds_, {axis.name, fmt::format("{}", points[i].value), c.name}, c);
    }
  }

  void report() const {
    std::vector<std::vector<std::string>> cells;
    for (const Row& r : rows_) {
      cells.push_back({r.axis, r.method, fmt::format("{}", r.value), text_of(r.wall_ms),
                       text_of(r.over_first), fmt::format("{:.3g}", r.cpu_over_first.median)});
    }
    fmt::print("\n{}\n",
               experiments::markdown_table(
                   {"of", "method", "value", "ms/frame", "over the first", "by CPU time"}, cells, 2));
    std::fflush(stdout);
    experiments::write_file(options_.out / "growth.csv", experiments::csv_text(columns(), rows_));
    experiments::write_file(options_.out / "growth_rounds.csv",
                            rounds_csv({"axis", "value", "method"}, rounds_));
  }

 private:
  std::vector<Point> points_of(const Axis& axis) {
    std::vector<Point> points;
    const auto count =
        static_cast<std::size_t>(std::ceil(options_.share * static_cast<double>(axis.values.size())));
    for (std::size_t i = 0; i < std::min(count, axis.values.size()); ++i) {
      const int value = axis.values[i];
      const bool of_triangles = axis.name == "triangles";
      const Scene generated = of_triangles ? room(static_cast<std::uint32_t>(value)) : Scene();
      const Scene& scene =
          of_triangles ? generated : scenes_.load(experiment_.scene_file(experiment_.runs.front())).scene;
      const double shown = of_triangles ? static_cast<double>(scene.triangles.size()) : value;
      for (Method method : methods(experiment_)) {
        if (axis.table_only && !has_table(method.settings)) continue;
        axis.apply(method.settings, value);
        add_point(points, {shown, method.name, nullptr}, scene, method.settings);
      }
    }
    return points;
  }

  // Leaves out what the device cannot hold, and says so.
  void add_point(std::vector<Point>& points, Point point, const Scene& scene,
                 const RenderSettings& settings) {
    try {
      point.tracer = std::make_unique<Tracer>(context_, scene, settings);
      points.push_back(std::move(point));
    } catch (const Error& error) {
      fmt::print("{} at {} is left out: {}\n", point.method, point.value, error.what());
    }
  }

  const gpu::Context& context_;
  const GrowthBenchOptions& options_;
  experiments::Experiment experiment_;
  experiments::SceneStore scenes_;
  std::vector<Row> rows_;
  std::vector<RoundRow> rounds_;
};

}  // namespace

void bench_growth(const gpu::Context& context, const GrowthBenchOptions& options) {
  GrowthBench bench(context, options);
  for (const Axis& axis : axes()) bench.run(axis);
  bench.report();
}

}  // namespace qtrace::bench
