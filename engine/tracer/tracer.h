// One run: a scene, settings and the buffers that belong to them, rendered frame by frame.
#pragma once

#include "engine/core/image.h"
#include "engine/core/settings.h"
#include "engine/gpu/context.h"
#include "engine/scene/scene.h"
#include "engine/tracer/counters.h"
#include "engine/tracer/qtable.h"
#include "engine/tracer/tracer_state.h"
#include "engine/tracer/trial.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace qtrace {

class Tracer {
 public:
  // Builds everything, compiles and warms up the shaders, so that the first frame is like the others.
  // Throws Error where the device cannot hold the scene or the table. The context must outlive the tracer.
  // `more`: defines of the tracing shader besides those of the settings, for tests of it.
  Tracer(const gpu::Context& context, const Scene& scene, const RenderSettings& settings,
         const gpu::Defines& more = {});
  ~Tracer();
  Tracer(Tracer&&) noexcept;
  Tracer& operator=(Tracer&&) noexcept;

  // What counts as a firefly: a sample whose mean over channels exceeds its pixel's threshold. One per pixel,
  // before the first frame; without them nothing does.
  void set_firefly_thresholds(std::span<const float> thresholds);

  // Enqueues one sample per pixel and, where there is a table, one update of it. Does not wait, but
  // where a trial of the table looks at its frames.
  void render_frame();
  std::uint32_t frames() const;

  // The readers below wait for enqueued work.
  FrameCounters last_frame_counters() const;
  std::vector<NonFiniteSample> non_finite_samples() const;  // some of all frames so far, at most 64
  Outliers outliers() const;                                // fireflies and clamping over all frames so far
  RadianceImage radiance() const;                           // mean and its variance over all frames
  std::array<RadianceImage, 2> halves() const;              // the same over the odd and over the even frames
  FirstHitImage first_hit() const;

  // To go on later: a tracer of the same scene and settings that restores a state continues after its frames
  // with the bits of one that was never interrupted. Throws Error, and changes nothing, where the state is of
  // another size or has other buffers.
  TracerState state() const;
  void restore(const TracerState& state);

  const std::vector<std::string>& warnings()
      const;                         // what of scene and settings is rendered otherwise, and how
  QTable* table();                   // null unless directions or lights are learned; for studies of the table
  void set_learning(bool learning);  // false: the table stays as it is

  // What they have found so far.
  const Trial& table_trial() const;
  const Trial& light_path_trial() const;

  std::uint64_t cells() const;         // states of the table; 0 where there is none
  std::uint64_t device_bytes() const;  // memory of all buffers

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace qtrace
