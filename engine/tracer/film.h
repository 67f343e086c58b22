// Per-pixel sums over the frames, odd and even ones apart, and the counts of the last frame.
#pragma once

#include "engine/core/image.h"
#include "engine/gpu/buffer.h"
#include "engine/gpu/program_cache.h"
#include "engine/gpu/structs.h"
#include "engine/tracer/counters.h"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace qtrace {

class Film {
 public:
  // `replicates`: sequences of random numbers that take turns; from two on they are summed apart, and their
  // spread is the variance. `light_paths`: of a frame.
  Film(int width, int height, int replicates, int light_paths, gpu::ProgramCache& programs);

  void bind() const;
  void start_frame();  // clears the frame's counters
  // Adds the frame's samples, times its weight, and what its light paths brought; parameters must be bound.
  void accumulate(std::uint32_t frame, float weight, bool has_light_paths);
  void reset();  // as at the start
  // Where samples were found elsewhere; as many as leave room for the film's own. No counter counts them.
  void note_non_finite(std::span<const NonFiniteSample> samples);
  // After buffers were restored that hold frames 1 to `last`: what these weigh.
  void count_all(std::uint32_t last, const std::function<float(std::uint32_t)>& weight);

  // One per pixel, before the first frame; without them nothing is a firefly.
  void set_firefly_thresholds(std::span<const float> thresholds);

  // These wait for enqueued work and throw Error where the driver cut a loop of a shader short.
  FrameCounters counters() const;
  std::vector<NonFiniteSample> non_finite_samples() const;  // ordered by frame, then position
  Outliers outliers() const;
  RadianceImage radiance() const;
  std::array<RadianceImage, 2> halves() const;  // of the odd and of the even frames
  // Of the odd and of the even frames, of the samples times their weights.
  std::array<std::vector<glm::vec3>, 2> half_sums() const;
  void check_loops() const;
  // Of the first so many light paths of the last frame: events that were kept for connections.
  double kept_events(std::uint32_t paths) const;

  // What has gathered over the frames so far.
  std::vector<gpu::Buffer*> gathered();

  std::size_t bytes() const {
    return samples_.bytes() + sums_.size() * sums_.front().bytes() + outliers_.bytes() + counters_.bytes() +
           (splats_ ? splats_->bytes() + light_paths_->bytes() : 0);
  }

 private:
  void count(std::uint32_t frame, float weight);
  // Of the frames of one buffer of sums.
  struct Weights {
    std::uint32_t frames = 0;
    double sum = 0;
    double squares = 0;
  };
  static Weights joined(const Weights& a, const Weights& b);
  RadianceImage image_of(const std::vector<gpu::PixelSum>& sums, const Weights& weights) const;
  std::pair<std::vector<gpu::PixelSum>, Weights> half(std::size_t half) const;
  RadianceImage over_samples() const;
  RadianceImage over_replicates() const;
  std::size_t place(std::uint32_t frame) const { return (frame + sums_.size() - 1) % sums_.size(); }
  Weights all_weights() const;

  int width_;
  int height_;
  int replicates_;
  gpu::Buffer samples_;
  std::vector<gpu::Buffer> sums_;  // frame f, from 1, belongs to sums_[(f - 1) % sums_.size()]
  std::vector<Weights> weights_;   // as sums_
  gpu::Buffer outliers_;
  gpu::Buffer counters_;
  std::optional<gpu::Buffer> splats_;       // of a frame, where paths start at lights: empty between frames
  std::optional<gpu::Buffer> light_paths_;  // what each of them counted
  std::shared_ptr<gpu::Program> accumulate_;
  std::shared_ptr<gpu::Program> accumulate_with_light_paths_;  // null where there are never any
};

}  // namespace qtrace
