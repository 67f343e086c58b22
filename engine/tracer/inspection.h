// A scene as a table sees it: the cells behind the pixels, and the light that truly arrives at one of them,
// to be laid beside what was learned.
#pragma once

#include "engine/core/settings.h"
#include "engine/gpu/context.h"
#include "engine/scene/scene.h"
#include "engine/tracer/cell_buffers.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <functional>
#include <memory>
#include <vector>

namespace qtrace {

// Incident radiance over the hemisphere about a normal, as a square image in Lambert's azimuthal equal-area
// projection: x along the cell's tangent, y upwards, the horizon as the inscribed circle.
struct Hemisphere {
  int size = 0;
  std::vector<int> bin;              // of each pixel's centre, -1 outside the disk
  std::vector<glm::dvec3> radiance;  // of each pixel: mean over its paths; 0 where there is none
  std::vector<double> bin_radiance;  // of each bin, averaged over the channels; NaN where no path fell
  std::vector<double> bin_cosine;    // mean over the bin
};

class Inspection {
 public:
  // `settings`: those of the run, with sampler rl. Throws Error where the device cannot hold them. The
  // context must outlive the inspection.
  Inspection(const gpu::Context& context, const Scene& scene, const RenderSettings& settings);
  ~Inspection();
  Inspection(Inspection&&) noexcept;
  Inspection& operator=(Inspection&&) noexcept;

  const std::vector<CellState>& cells() const;
  std::size_t actions() const;  // of each of the table's states

  // Row of the table that belongs to what each pixel's centre shows, -1 where there is none.
  std::vector<int> pixel_cells() const;

  // Path traced with BSDF sampling and one_ray, as many bounces as the run's and other random numbers, so
  // that it owes the table nothing. `pixel` must show a cell; `samples`: paths per pixel of the hemisphere.
  // `after_each` is told how many are done.
  Hemisphere hemisphere(glm::ivec2 pixel, int size, int samples,
                        const std::function<void(int)>& after_each = {}) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace qtrace
