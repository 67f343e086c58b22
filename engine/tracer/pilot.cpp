#include "engine/tracer/pilot.h"

#include "engine/gpu/structs.h"
#include "engine/tracer/frame.h"
#include "engine/tracer/limits.h"
#include "engine/tracer/parameters.h"
#include "engine/tracer/sample_sequence.h"
#include "engine/tracer/sobol.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

namespace qtrace {
namespace {

// Of the image's width and height, at most.
constexpr double kLargestScale = 0.5;
// What suffices to teach a table and to tell what it is worth, however large the image is.
constexpr double kMostPixels = 128 * 128;
// Its frames count from 1, as the image's do, so their random numbers need a seed of their own.
constexpr std::uint32_t kSeed = 0x70696c6f;

RenderSettings pilot_settings(RenderSettings settings) {
  const double pixels = static_cast<double>(settings.width) * settings.height;
  const double scale = std::min(kLargestScale, std::sqrt(kMostPixels / pixels));
  const auto scaled = [&](int side) { return std::max(1, static_cast<int>(std::lround(scale * side))); };
  settings.width = scaled(settings.width);
  settings.height = scaled(settings.height);
  if (settings.light_path_count > 0) {
    const double count = std::round(scale * scale * settings.light_path_count);
    settings.light_path_count = std::max(1, static_cast<int>(count));
  }
  settings.clamp_radiance = 0;
  settings.seed = mixed(settings.seed ^ kSeed);
  return settings;
}

// An update costs as much as a frame of a simple scene, so there are few: when what the table has seen has
// doubled, after the last lesson, and before its sums could be full.
bool learns_after(std::uint32_t lesson, std::uint32_t lessons, std::uint32_t most_taught) {
  return std::has_single_bit(lesson) || lesson == lessons || lesson % most_taught == 0;
}

}  // namespace

Pilot::Pilot(const Camera& camera, const RenderSettings& settings, const gpu::SceneFeatures& features,
             const CellBuffers* cells, gpu::ProgramCache& programs)
    : settings_(pilot_settings(settings)),
      image_size_(settings.width, settings.height),
      most_taught_(most_taught_frames(settings_)),
      film_(settings_.width, settings_.height, 1, light_paths_of_a_frame(settings_), programs),
      parameter_block_("parameters of the pilot", sizeof(gpu::Parameters)) {
  const gpu::Parameters parameters = make_parameters(camera, settings_, features, cells);
  parameter_block_.write(0, &parameters, sizeof(parameters));
}

void Pilot::set_connections(float connections) {
  parameter_block_.write(offsetof(gpu::Parameters, connections), &connections, sizeof(connections));
}

void Pilot::render(const Shaders& shaders, Trial& trial, bool teaches, const std::function<void()>& learn) {
  parameter_block_.bind_uniform(gpu::BINDING_PARAMETERS);
  film_.bind();
  film_.reset();
  std::array<FrameCounters, 2> last;
  for (std::uint32_t frame = 1; frame <= trial.pilot_frames() && !trial.is_decided(); ++frame) {
    const bool is_lesson = frame <= trial.pilot_lessons();
    if (frame == trial.pilot_lessons() + 1) {
      note_non_finite();
      film_.reset();
    }
    const std::size_t kind = trial.pilot_is_without(frame) ? 0 : 1;
    render_frame({.number = frame, .place = pilot_place(frame, trial), .teaches = is_lesson && teaches},
                 settings_, kind == 0 ? shaders.without : shaders.with, film_);
    if (is_lesson && teaches && learns_after(frame, trial.pilot_lessons(), most_taught_)) learn();
    last[kind] = film_.counters();
    counters_ += last[kind];
    if (trial.looks_after_pilot(frame))
      trial.look_at_pilot({frame, settings_.width, film_.half_sums(), last});
  }
  note_non_finite();
}

// A pixel of the small picture shows what several of the image do: the middle one of these.
void Pilot::note_non_finite() {
  const glm::uvec2 size(settings_.width, settings_.height);
  for (const NonFiniteSample& sample : film_.non_finite_samples()) {
    const glm::uvec2 place = (2U * glm::uvec2(sample.x, sample.y) + 1U) * image_size_ / (2U * size);
    non_finite_samples_.push_back({place.x, place.y, 0});
  }
}

}  // namespace qtrace
