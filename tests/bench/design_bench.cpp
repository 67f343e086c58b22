#include "tests/bench/design_bench.h"

#include "engine/accel/build_bvh.h"
#include "engine/gpu/driver.h"
#include "engine/device_scene/scene_buffers.h"
#include "engine/gpu/structs.h"
#include "experiments/files/atomic_file.h"
#include "experiments/files/csv.h"
#include "experiments/files/text_table.h"
#include "tests/bench/embree.h"
#include "tests/bench/ray_shader.h"
#include "tests/bench/rounds.h"
#include "tests/bench/scenes.h"

#include <algorithm>
#include <cstdio>
#include <thread>

namespace qtrace::bench {
namespace {

constexpr int kBounces = 5;  // Goswami's

// A wavefront keeps its paths in memory between passes: origin, direction, throughput and radiance with what
// fits beside them. Each scattering event reads them and writes them once.
constexpr std::size_t kStateBytes = 64;
constexpr std::string_view kState = R"(#version 450 core
#include "shared/structs.glsl"
layout(local_size_x = 64) in;
struct PathState { vec4 origin; vec4 direction; vec4 throughput; vec4 radiance; };
layout(std430, binding = BINDING_OUTPUT) restrict buffer StateBuffer { PathState states[]; };
void main() {
  uint index = gl_GlobalInvocationID.x;
  PathState s = states[index];
  s.origin += s.direction;
  s.radiance += s.throughput;
  s.throughput *= 0.5;
  s.direction = s.direction.yzwx;
  states[index] = s;
}
)";

enum Stage : std::size_t { frame, with_gloss, with_environment, with_both, primary, bounce, sorted, state };

struct Design {
  std::string name;
  std::vector<std::pair<double, Stage>> parts;  // a sum of stages, each so many times
};

struct Row {
  std::string scene;
  std::string design;
  int size;
  Spread wall_ms;
  Spread over_frame;      // by the clock
  Spread cpu_over_frame;  // by processor time
};

const std::vector<experiments::Column<Row>>& columns() {
  static const std::vector<experiments::Column<Row>> all{
      {"scene", [](const Row& r) { return r.scene; }},
      {"design", [](const Row& r) { return r.design; }},
      {"size", [](const Row& r) { return std::int64_t{r.size}; }},
      {"wall_ms", [](const Row& r) { return r.wall_ms.median; }},
      {"wall_ms_low", [](const Row& r) { return r.wall_ms.low; }},
      {"wall_ms_high", [](const Row& r) { return r.wall_ms.high; }},
      {"over_frame", [](const Row& r) { return r.over_frame.median; }},
      {"over_frame_low", [](const Row& r) { return r.over_frame.low; }},
      {"over_frame_high", [](const Row& r) { return r.over_frame.high; }},
      {"cpu_over_frame", [](const Row& r) { return r.cpu_over_frame.median; }},
  };
  return all;
}

RenderSettings plain_settings(int size) {
  RenderSettings settings;
  settings.random = RandomNumbers::independent;
  settings.width = settings.height = size;
  settings.max_bounces = settings.russian_roulette_start = kBounces;
  settings.sampler = Sampler::bsdf;
  settings.nee = Nee::none;
  return settings;
}

// Everything that is timed in one scene.
class Stages {
 public:
  Stages(const gpu::Context& context, const Scene& scene, int size)
      : context_(context),
        plain_(context, scene, plain_settings(size)),
        gloss_(context, scene, plain_settings(size), {{"HAS_SPECULAR", "1"}}),
        environment_(context, scene, plain_settings(size), {{"HAS_ENVIRONMENT", "1"}}),
        both_(context, scene, plain_settings(size), {{"HAS_SPECULAR", "1"}, {"HAS_ENVIRONMENT", "1"}}),
        buffers_(scene, build_bvh(scene, BvhKind::sah)),
        sets_(make_rays(scene, EmbreeScene(scene, std::max(1U, std::thread::hardware_concurrency())), size)),
        primary_(sets_.primary),
        bounce_(sets_.bounce),
        sorted_(sorted_rays(sets_.bounce)),
        query_(false, {}),
        states_("path states", sets_.primary.size() * kStateBytes),
        move_states_(gpu::assemble("bench_state.comp", kState, gpu::for_driver({}))) {}

  std::vector<Contender> contenders() {
    const auto tracing = [this](Tracer& tracer) {
      return [this, &tracer] { return timed_frame(context_, tracer); };
    };
    const auto asking = [this](const RayBuffers& rays) {
      return [this, &rays] {
        buffers_.bind();
        return timed([&] { query_.trace(rays); }, [&] { context_.finish(); });
      };
    };
    const auto moving = [this] {
      states_.bind_storage(gpu::BINDING_OUTPUT);
      const auto groups = static_cast<std::uint32_t>(sets_.primary.size() / 64);
      return timed([&] { move_states_.dispatch(groups); }, [&] { context_.finish(); });
    };
    return {{"frame", tracing(plain_)},
            {"with gloss", tracing(gloss_)},
            {"with environment", tracing(environment_)},
            {"with both", tracing(both_)},
            {"primary rays", asking(primary_)},
            {"bounce rays", asking(bounce_)},
            {"sorted bounce rays", asking(sorted_)},
            {"path states", moving}};
  }

  // Of what a frame needs, by what it did: rays of the camera, and later ones in units of the measured set.
  std::vector<Design> designs() const {
    const auto paths = static_cast<double>(sets_.primary.size());
    const double later = static_cast<double>(plain_.last_frame_counters().rays) - paths;
    const double sets = later / static_cast<double>(sets_.bounce.size());
    const double events = later / paths;
    return {{"the frame: one kernel", {{1, frame}}},
            {"with code for glossy lobes", {{1, with_gloss}}},
            {"with code for an environment", {{1, with_environment}}},
            {"with both", {{1, with_both}}},
            {"wavefront: its ray queries", {{1, primary}, {sets, bounce}}},
            {"wavefront: its path states", {{events, state}}},
            {"wavefront: both, without shading", {{1, primary}, {sets, bounce}, {events, state}}},
            {"the same, rays sorted by nobody", {{1, primary}, {sets, sorted}, {events, state}}}};
  }

 private:
  const gpu::Context& context_;
  Tracer plain_, gloss_, environment_, both_;
  gpu::SceneBuffers buffers_;
  RaySets sets_;
  RayBuffers primary_, bounce_, sorted_;
  RayShader query_;
  gpu::Buffer states_;
  gpu::Program move_states_;
};

std::vector<double> times_of(const Design& design, const std::vector<Contender>& contenders,
                             std::vector<double> Contender::*times) {
  std::vector<double> sums((contenders[frame].*times).size());
  for (const auto& [count, stage] : design.parts) {
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += count * (contenders[stage].*times)[i];
  }
  return sums;
}

void print(const std::vector<Row>& rows) {
  std::vector<std::vector<std::string>> cells;
  for (const Row& r : rows) {
    cells.push_back(
        {r.scene, r.design, text_of(r.wall_ms), text_of(r.over_frame), text_of(r.cpu_over_frame)});
  }
  fmt::print("\n{}\n", experiments::markdown_table({"scene", "design", "ms", "over the frame", "by CPU time"},
                                                   cells, 2));
  std::fflush(stdout);
}

}  // namespace

void bench_designs(const gpu::Context& context, const FrameBenchOptions& options) {
  std::vector<Row> rows;
  std::vector<RoundRow> rounds;
  for (const std::string name : {QTRACE_SOURCE_DIR "/configs/scenes/simple.glb", "room:200000"}) {
    const Scene scene = bench_scene(name);
    const std::string scene_name = shown_name(name, scene);
    Stages stages(context, scene, options.size);
    std::vector<Contender> contenders = stages.contenders();
    run_rounds(contenders, options.rounds);
    for (const Design& design : stages.designs()) {
      const std::vector<double> wall = times_of(design, contenders, &Contender::wall_s);
      rows.push_back({scene_name, design.name, options.size, kMilliseconds * spread_of(wall),
                      ratio_of(wall, contenders[frame].wall_s),
                      ratio_of(times_of(design, contenders, &Contender::cpu_s), contenders[frame].cpu_s)});
    }
    for (const Contender& c : contenders) append_rounds(rounds, {scene_name, c.name}, c);
  }
  print(rows);
  experiments::write_file(options.out / "designs.csv", experiments::csv_text(columns(), rows));
  experiments::write_file(options.out / "design_rounds.csv", rounds_csv({"scene", "stage"}, rounds));
}

}  // namespace qtrace::bench
