// The renderer beside the independent tracer, on one scene.
#pragma once

#include "engine/core/image.h"
#include "engine/core/settings.h"
#include "tests/independent/agreement.h"
#include "tests/independent/path_tracer.h"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace qtrace::independent {

// All shipped ones (open_sky and sunlit_bath with their skies), and the Cornell box in metal and plastic.
inline constexpr std::array kScenes{"simple.glb",          "occluded.glb", "cornell_box.glb",
                                    "many_lights.glb",     "furnace.glb",  "door_ajar.glb",
                                    "glossy_room.glb",     "open_sky.glb", "sunlit_bath.glb",
                                    "lamp_in_fixture.glb", "corridor.glb", "glossy"};

// Whether a scene is the path of a file, and not one of those that are known by name.
bool is_file(const std::string& scene);

// Chance that a true renderer fails one comparison.
inline constexpr double kQuickChance = 1e-4;

class Comparison {
 public:
  struct Size {
    int size;     // pixels each way: whole pools of blocks (agreement.h)
    int samples;  // of the independent tracer, at least
    // Doubled up to this many until the mean is known to half the variance that `precision` allows.
    int most_samples = 0;
    double precision = 0;
  };
  // `scene`: of kScenes, of kRooms, or the path of a .glb, whose light from outside is none.
  Comparison(const std::string& scene, Size size);

  int samples() const { return samples_; }  // of the independent tracer, per pixel

  // Renders at least `frames`, and on up to `most_frames` until the ratio of the means is known to
  // `precision`. `watch` sees what is known after each part of `frames`.
  // With Sobol' points it has 16 replicates, whose spread is its variance.
  Agreement measure(Sampler sampler, Nee nee, int frames, int most_frames = 0, double precision = 0,
                    const std::function<void(const Agreement&)>& watch = {},
                    RandomNumbers random = RandomNumbers::independent,
                    LightChoice lights = LightChoice::power) const;

  // With paths from the lights. What one of them brings to several pixels ties these together, so the noise
  // of blocks and of the whole comes from the spread of `kSeeds` renders of so many frames each.
  static constexpr int kSeeds = 16;
  Agreement measure_light_paths(Sampler sampler, Nee nee, LightPaths paths, int frames,
                                LightChoice lights = LightChoice::power) const;

 private:
  RenderSettings settings_of(Sampler sampler, Nee nee, RandomNumbers random, LightChoice lights) const;
  Agreement compare(const RadianceImage& image) const;
  Agreement compare(const std::vector<RadianceImage>& seeds) const;
  double truth_error() const;  // of the mean, relative

  Scene scene_;
  double sky_;  // radiance of its environment, in every channel
  Size size_;
  int samples_ = 0;
  Image truth_;
  std::vector<char> edges_;  // see edges_of_lights()
};

}  // namespace qtrace::independent
