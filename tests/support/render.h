// Rendering for tests, and the samplers that every statement about truth is tried with.
#pragma once

#include "engine/tracer/tracer.h"
#include "tests/support/device.h"

#include <string>
#include <vector>

namespace qtrace::test {

struct Method {
  std::string name;
  Sampler sampler = Sampler::bsdf;
  Nee nee = Nee::none;
  UpdateRule update = UpdateRule::expected_sarsa;
};

// Every sampler (rl with both rules) with every kind of next event estimation.
inline std::vector<Method> all_methods() {
  std::vector<Method> methods;
  for (const Nee nee : {Nee::none, Nee::one_ray, Nee::two_ray}) {
    const std::string suffix = " + " + std::string(enum_name(nee));
    methods.push_back({"bsdf" + suffix, Sampler::bsdf, nee, {}});
    methods.push_back({"uniform" + suffix, Sampler::uniform, nee, {}});
    methods.push_back({"rl expected_sarsa" + suffix, Sampler::rl, nee, UpdateRule::expected_sarsa});
    methods.push_back({"rl q_learning" + suffix, Sampler::rl, nee, UpdateRule::q_learning});
  }
  return methods;
}

inline RenderSettings with_method(RenderSettings settings, const Method& method) {
  settings.sampler = method.sampler;
  settings.nee = method.nee;
  settings.rl.update = method.update;
  return settings;
}

// A square picture by the BSDF's own directions and independent numbers, whose blocks have a spread.
inline RenderSettings square_settings(int size, int max_bounces, Nee nee = Nee::none) {
  RenderSettings settings;
  settings.width = settings.height = size;
  settings.sampler = Sampler::bsdf;
  settings.max_bounces = max_bounces;
  settings.nee = nee;
  settings.random = RandomNumbers::independent;
  return settings;
}

struct Rendering {
  RadianceImage image;
  std::uint64_t non_finite = 0;
};

inline Rendering render(Tracer& tracer, int frames) {
  Rendering result;
  for (int i = 0; i < frames; ++i) {
    tracer.render_frame();
    result.non_finite += tracer.last_frame_counters().non_finite;
  }
  result.image = tracer.radiance();
  return result;
}

inline Rendering render(const Scene& scene, const RenderSettings& settings, int frames) {
  Tracer tracer(device(), scene, settings);
  return render(tracer, frames);
}

}  // namespace qtrace::test
