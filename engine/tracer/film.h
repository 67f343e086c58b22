// Per-pixel sums over the frames, odd and even ones apart, and the counts of the last frame.
#pragma once

#include "engine/core/image.h"
#include "engine/gpu/buffer.h"
#include "engine/gpu/program_cache.h"
#include "engine/tracer/counters.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace qtrace {

class Film {
 public:
  Film(int width, int height, gpu::ProgramCache& programs);

  void bind() const;
  void start_frame();                    // clears the frame's counters
  void accumulate(std::uint32_t frame);  // adds the frame's samples; parameters must be bound
  void reset();                          // as at the start

  // One per pixel, before the first frame; without them nothing is a firefly.
  void set_firefly_thresholds(std::span<const float> thresholds);

  // These wait for enqueued work and throw Error where the driver cut a loop of a shader short.
  FrameCounters counters() const;
  std::vector<NonFiniteSample> non_finite_samples() const;  // ordered by frame, then position
  Outliers outliers() const;
  RadianceImage radiance(std::uint32_t frames) const;
  std::array<RadianceImage, 2> halves(std::uint32_t frames) const;  // of the odd and of the even frames
  void check_loops() const;

  // What has gathered over the frames so far.
  std::vector<gpu::Buffer*> gathered();

  std::size_t bytes() const {
    return samples_.bytes() + odd_sums_.bytes() + even_sums_.bytes() + outliers_.bytes() + counters_.bytes();
  }

 private:
  int width_;
  int height_;
  gpu::Buffer samples_;
  gpu::Buffer odd_sums_;
  gpu::Buffer even_sums_;
  gpu::Buffer outliers_;
  gpu::Buffer counters_;
  std::shared_ptr<gpu::Program> accumulate_;
};

}  // namespace qtrace
