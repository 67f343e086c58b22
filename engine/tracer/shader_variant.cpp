#include "engine/tracer/shader_variant.h"

#include <algorithm>
#include <string>

namespace qtrace {

gpu::Defines shader_defines(const RenderSettings& settings, const gpu::SceneFeatures& features) {
  const auto number = [](auto choice) { return std::to_string(static_cast<int>(choice)); };
  gpu::Defines defines;
  defines["SAMPLER"] = number(settings.sampler);
  // Without lights there is nothing to sample; the path's own rays then count all there is.
  defines["NEE"] = number(features.lights > 0 ? settings.nee : Nee::none);
  if (features.specular) defines["HAS_SPECULAR"] = "1";
  if (std::ranges::any_of(settings.environment, [](double e) { return e > 0; }))
    defines["HAS_ENVIRONMENT"] = "1";
  if (settings.sampler == Sampler::rl) {
    defines["BINS_THETA"] = number(settings.rl.bins_theta);
    defines["BINS_PHI"] = number(settings.rl.bins_phi);
    defines["UPDATE_RULE"] = number(settings.rl.update);
  }
  return defines;
}

}  // namespace qtrace
