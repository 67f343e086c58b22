#include "engine/tracer/tracer.h"

#include "engine/accel/build_bvh.h"
#include "engine/core/check.h"
#include "engine/device_scene/scene_buffers.h"
#include "engine/gpu/structs.h"
#include "engine/tracer/film.h"
#include "engine/tracer/frame.h"
#include "engine/tracer/learning_schedule.h"
#include "engine/tracer/light_vertices.h"
#include "engine/tracer/limits.h"
#include "engine/tracer/parameters.h"
#include "engine/tracer/pilot.h"
#include "engine/tracer/sample_sequence.h"
#include "engine/tracer/shader_variant.h"
#include "engine/tracer/tiles.h"
#include "engine/tracer/trial.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

namespace qtrace {
namespace {

// In states.
constexpr const char* kTableTrial = "trial of the table";
constexpr const char* kLightPathTrial = "trial of light paths";
// A GPU that waits lowers its clock, and the first milliseconds of work do not raise it again (seen on an
// H200).
constexpr std::chrono::milliseconds kClockRise{50};

gpu::Defines joined(gpu::Defines defines, const gpu::Defines& more) {
  defines.insert(more.begin(), more.end());
  return defines;
}

}  // namespace

struct Tracer::State {
  State(const gpu::Context& gpu_context, const Scene& scene, const RenderSettings& wanted,
        const gpu::Defines& more)
      : context(gpu_context),
        buffers(scene, build_bvh(scene, wanted.bvh), wanted.lights),
        settings(effective_settings(wanted, buffers.features())),
        film(settings.width, settings.height, settings.replicates, light_paths_of_a_frame(settings),
             context.programs()),
        schedule(settings, has_table(settings) ? most_taught_frames(settings) : 1),
        table_trial(trial_of_table(settings)),
        light_path_trial(trial_of_light_paths(settings)),
        parameter_block("parameters", sizeof(gpu::Parameters)) {
    if (has_table(settings)) {
      table.emplace(scene, settings.rl, table_actions(settings, buffers.features()),
                    shader_defines(settings, buffers.features()), context.programs());
    }
    if (settings.light_paths == LightPaths::connect) light_vertices.emplace(settings);
    make_shaders(more);
    const CellBuffers* cells = table ? &table->cells() : nullptr;
    if (table_trial.is_wanted() || light_path_trial.is_wanted())
      pilot.emplace(scene.camera, settings, buffers.features(), cells, context.programs());
    const gpu::Parameters parameters = make_parameters(scene.camera, settings, buffers.features(), cells);
    parameter_block.write(0, &parameters, sizeof(parameters));
    warnings = buffers.warnings();
    if (table) {
      const std::vector<std::string>& of_cells = table->cells().warnings();
      warnings.insert(warnings.end(), of_cells.begin(), of_cells.end());
    }
  }

  // All kinds of frames that there may be: trials leave something out.
  void make_shaders(const gpu::Defines& more) {
    RenderSettings of_frame = settings;
    const bool leaves_table = table_trial.is_wanted() || light_path_trial.is_wanted();
    const bool may_have_paths = settings.light_paths != LightPaths::none;
    for (const bool has_paths : {false, true}) {
      const bool is_needed = has_paths ? may_have_paths : !may_have_paths || light_path_trial.is_wanted();
      if (!is_needed) continue;
      of_frame.light_paths = has_paths ? settings.light_paths : LightPaths::none;
      for (const bool guides : {false, true}) {
        of_frame.sampler = guides || settings.sampler != Sampler::rl ? settings.sampler : Sampler::bsdf;
        if (guides || leaves_table) kinds[has_paths][guides] = shaders_of(of_frame, more);
      }
    }
  }

  FrameShaders shaders_of(const RenderSettings& of_frame, const gpu::Defines& more) const {
    gpu::Defines defines = shader_defines(of_frame, buffers.features());
    if (has_table(of_frame)) defines = with_cells(defines, table->cells());
    defines = joined(defines, more);
    FrameShaders result;
    result.trace = context.programs().get("passes/trace.comp", defines);
    if (of_frame.light_paths != LightPaths::none)
      result.trace_light = context.programs().get("passes/trace_light.comp", defines);
    return result;
  }

  // Of the frames that come, with the table or without it.
  const FrameShaders& shaders(bool guides) const {
    const bool has_paths = settings.light_paths != LightPaths::none && !light_path_trial.gave_up();
    return kinds[has_paths][guides];
  }

  void bind() const {
    parameter_block.bind_uniform(gpu::BINDING_PARAMETERS);
    buffers.bind();
    film.bind();
    if (light_vertices) light_vertices->bind();
    if (table) table->bind();
  }

  std::pair<std::uint32_t, std::uint32_t> groups() const {
    return {tiles(settings.width), tiles(settings.height)};
  }

  std::array<std::pair<const char*, Trial*>, 2> trials() {
    return {{{kTableTrial, &table_trial}, {kLightPathTrial, &light_path_trial}}};
  }

  std::vector<gpu::Buffer*> gathered() {
    std::vector<gpu::Buffer*> all = film.gathered();
    if (table) std::ranges::copy(table->learned(), std::back_inserter(all));
    return all;
  }

  // Drivers compile at the first dispatch: one work group of each shader. Everything is as at the start then.
  void warm_up() {
    bind();
    if (table) table->reset();
    for (const auto& pair : kinds) {
      for (const FrameShaders& kind : pair) {
        if (!kind.trace) continue;
        for (gpu::Program* program : kind.all()) {
          program->set_frame(0);
          program->set_teaches(true);
          program->dispatch(1);
        }
        film.accumulate(0, 1, kind.trace_light != nullptr);
      }
    }
    expect_connections();
    context.finish();
    if (!context.device().software) keep_busy();
    film.check_loops();
    film.reset();
    if (table) table->reset();
    context.finish();
  }

  // Light paths of a frame that counts nowhere tell how many events a path has.
  void expect_connections() {
    if (!light_vertices) return;
    trace_light_paths(settings, shaders(true));
    const float connections = light_vertices->connections(film);
    parameter_block.write(offsetof(gpu::Parameters, connections), &connections, sizeof(connections));
    if (pilot) pilot->set_connections(connections);
  }

  float weight(std::uint32_t frame) const { return frame_weight(frame, settings, table_trial); }

  // Before the first frame.
  void render_pilot() {
    if (!pilot) return;
    bind();
    if (light_path_trial.is_wanted())
      pilot->render({kinds[true][false], kinds[false][false]}, light_path_trial, false, {});
    if (table_trial.is_wanted())
      pilot->render({shaders(true), shaders(false)}, table_trial, learning, [this] { table->learn(); });
    film.note_non_finite(pilot->non_finite_samples());
    of_pilot = pilot->counters();
  }

  void look() {
    table_trial.look({.frame = frames,
                      .weights = {weight(frames - 1), weight(frames)},
                      .width = settings.width,
                      .sums = film.half_sums(),
                      .counters = film.counters()});
  }

  void keep_busy() {
    const auto [x, y] = groups();
    const auto start = std::chrono::steady_clock::now();
    do {
      shaders(true).trace->dispatch(x, y);
      context.finish();
    } while (std::chrono::steady_clock::now() - start < kClockRise);
  }

  const gpu::Context& context;
  gpu::SceneBuffers buffers;
  RenderSettings settings;  // as they take effect
  Film film;
  LearningSchedule schedule;
  Trial table_trial;
  Trial light_path_trial;
  gpu::Buffer parameter_block;
  std::array<std::array<FrameShaders, 2>, 2> kinds;  // by whether light paths, and the table, take part
  std::optional<LightVertices> light_vertices;
  std::optional<QTable> table;
  std::optional<Pilot> pilot;  // where a trial is wanted
  std::vector<std::string> warnings;
  FrameCounters of_pilot;  // none after a restored state
  std::uint32_t frames = 0;
  bool learning = true;
};

Tracer::Tracer(const gpu::Context& context, const Scene& scene, const RenderSettings& settings,
               const gpu::Defines& more) {
  check_limits(context, scene, settings);
  state_ = std::make_unique<State>(context, scene, settings, more);
  state_->warm_up();
}

Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;
Tracer& Tracer::operator=(Tracer&&) noexcept = default;

void Tracer::set_firefly_thresholds(std::span<const float> thresholds) {
  check(state_->frames == 0, "firefly thresholds must be set before the first frame, not after {}",
        state_->frames);
  state_->film.set_firefly_thresholds(thresholds);
}

void Tracer::render_frame() {
  State& s = *state_;
  if (s.frames == 0) s.render_pilot();
  ++s.frames;
  s.bind();
  const Frame frame{.number = s.frames,
                    .place = sequence_place(s.frames, s.settings, s.schedule, s.table_trial),
                    .teaches = s.learning && s.schedule.teaches(s.frames),
                    .weight = s.weight(s.frames)};
  qtrace::render_frame(frame, s.settings, s.shaders(!s.table_trial.is_without(s.frames)), s.film);
  if (s.table && s.learning && !s.table_trial.gave_up() && s.schedule.updates(s.frames)) s.table->learn();
  if (s.table_trial.looks_after(s.frames)) s.look();
}

std::uint32_t Tracer::frames() const { return state_->frames; }

FrameCounters Tracer::last_frame_counters() const {
  FrameCounters counters = state_->film.counters();
  if (state_->frames == 1) counters += state_->of_pilot;
  return counters;
}

std::vector<NonFiniteSample> Tracer::non_finite_samples() const { return state_->film.non_finite_samples(); }

Outliers Tracer::outliers() const { return state_->film.outliers(); }

RadianceImage Tracer::radiance() const { return state_->film.radiance(); }

std::array<RadianceImage, 2> Tracer::halves() const { return state_->film.halves(); }

TracerState Tracer::state() const {
  state_->film.check_loops();
  TracerState saved{state_->frames, {}};
  for (const gpu::Buffer* buffer : state_->gathered()) {
    saved.buffers.push_back({buffer->name(), buffer->read_all<std::byte>()});
  }
  for (const auto& [name, trial] : state_->trials()) {
    if (trial->is_wanted()) saved.buffers.push_back({name, trial->saved()});
  }
  return saved;
}

void Tracer::restore(const TracerState& saved) {
  const std::vector<gpu::Buffer*> buffers = state_->gathered();
  std::size_t count = buffers.size();
  for (const auto& [name, trial] : state_->trials()) count += trial->is_wanted() ? 1U : 0U;
  check(saved.buffers.size() == count, "the state has {} buffers where this tracer has {}",
        saved.buffers.size(), count);
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const SavedBuffer& from = saved.buffers[i];
    check(from.name == buffers[i]->name() && from.bytes.size() == buffers[i]->bytes(),
          "the state has {} bytes of {} where this tracer has {} of {}", from.bytes.size(), from.name,
          buffers[i]->bytes(), buffers[i]->name());
  }
  std::size_t place = buffers.size();
  for (const auto& [name, trial] : state_->trials()) {
    if (trial->is_wanted()) trial->restore(saved.buffers[place++].bytes);
  }
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    buffers[i]->write(0, saved.buffers[i].bytes.data(), saved.buffers[i].bytes.size());
  }
  state_->of_pilot = {};
  state_->frames = saved.frames;
  state_->film.count_all(saved.frames, [&](std::uint32_t frame) { return state_->weight(frame); });
}

FirstHitImage Tracer::first_hit() const {
  const State& s = *state_;
  const auto pixels =
      static_cast<std::size_t>(s.settings.width) * static_cast<std::size_t>(s.settings.height);
  gpu::Buffer output("first hits", pixels * sizeof(gpu::FirstHit));
  s.bind();
  output.bind_storage(gpu::BINDING_OUTPUT);
  const auto program =
      s.context.programs().get("passes/first_hit.comp", shader_defines(s.settings, s.buffers.features()));
  const auto [x, y] = s.groups();
  program->dispatch(x, y);
  s.context.finish();
  s.film.check_loops();
  FirstHitImage image{s.settings.width, s.settings.height, {}, {}, {}, {}};
  for (const gpu::FirstHit& hit : output.read_all<gpu::FirstHit>()) {
    image.normal.emplace_back(hit.normal);
    image.position.emplace_back(hit.position);
    image.albedo.emplace_back(hit.albedo);
    image.emission.emplace_back(hit.emission);
  }
  return image;
}

QTable* Tracer::table() {
  state_->bind();  // what is done with the table runs its update shader
  return state_->table ? &*state_->table : nullptr;
}

const Trial& Tracer::table_trial() const { return state_->table_trial; }

const Trial& Tracer::light_path_trial() const { return state_->light_path_trial; }

void Tracer::set_learning(bool learning) { state_->learning = learning; }

const std::vector<std::string>& Tracer::warnings() const { return state_->warnings; }

std::uint64_t Tracer::cells() const { return state_->table ? state_->table->cells().count() : 0; }

std::uint64_t Tracer::device_bytes() const {
  return state_->buffers.bytes() + state_->film.bytes() + state_->parameter_block.bytes() +
         (state_->light_vertices ? state_->light_vertices->bytes() : 0) +
         (state_->table ? state_->table->bytes() : 0) + (state_->pilot ? state_->pilot->bytes() : 0);
}

}  // namespace qtrace
