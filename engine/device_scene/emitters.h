// What triangles emit, where a texture may say so point by point.
#pragma once

#include "engine/scene/scene.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace qtrace::gpu {

class Emitters {
 public:
  explicit Emitters(const Scene& scene);
  ~Emitters();

  // Whether some point of the triangle may emit: by its material, and by the texels that its coordinates
  // cover.
  bool emits(std::uint32_t triangle) const;

  // Radiance that the triangle emits, averaged over its points and the channels. Above 0 where emits(): what
  // chooses lights by it must reach each that emits, although an average of samples may have missed it.
  double mean_radiance(std::uint32_t triangle) const;

 private:
  struct Lamp;  // an image of emission

  const Lamp* lamp_of(std::uint32_t triangle) const;

  const Scene& scene_;
  std::vector<std::unique_ptr<Lamp>> lamps_;  // by material; null without a texture of emission
};

}  // namespace qtrace::gpu
