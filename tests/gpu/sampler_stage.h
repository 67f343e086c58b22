// One point of a floor on the device, and its samplers of directions: what they draw, and the density that
// they state.
#pragma once

#include "engine/device_scene/scene_buffers.h"
#include "engine/tracer/qtable.h"
#include "tests/support/probe.h"

#include <glm/mat3x3.hpp>

#include <optional>
#include <string>
#include <vector>

namespace qtrace::test {

struct SamplerCase {
  std::string name;
  Sampler sampler = Sampler::bsdf;
  double bsdf_fraction = 0;
  int table = 0;  // 0: zeros, 1: random, 2: one huge bin
  Material material;
  bool tilted = false;   // the normal points to -z, where the tangent frame takes its other branch
  bool back = false;     // the floor shows its back face
  float cosine = 0.25F;  // of the angle under which it is viewed
};

// Which of the shaders' functions: that of the run's sampler, or the BSDF's own, whatever the run's is.
enum class Drawer { run, bsdf };

struct Draws {
  std::vector<double> counts;  // by cells of the sphere, of directions that have a density
  double smooth = 0;           // by smooth lobes
  double outside = 0;          // where nothing is reflected, by rough ones
  double weight = 0;           // of smooth lobes: its mean over all draws,
  double weight_variance = 0;  // and the variance of that mean
};

struct Stated {
  std::vector<double> counts;  // as above, expected
  double smooth_share = 0;
};

class SamplerStage {
 public:
  static constexpr std::uint32_t kSamples = 1 << 18;

  explicit SamplerStage(const SamplerCase& c);
  Draws draws(Drawer drawer = Drawer::run) const;
  // Integral of the density over each cell, times the number of samples.
  Stated stated(Drawer drawer = Drawer::run) const;

 private:
  std::string in_world() const;

  glm::mat3 tilt_;
  Scene scene_;
  RenderSettings settings_;
  gpu::SceneBuffers buffers_;
  gpu::Defines defines_;
  std::optional<QTable> table_;
  gpu::Buffer block_{"parameters", sizeof(gpu::Parameters)};
  gpu::Buffer counters_{"counters", 4096};
};

}  // namespace qtrace::test
