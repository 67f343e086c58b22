#include "engine/device_scene/punctual_lights.h"

#include <algorithm>
#include <cmath>

namespace qtrace::gpu {
namespace {

double mean_intensity(const PunctualLight& light) {
  return (double{light.intensity.r} + double{light.intensity.g} + double{light.intensity.b}) / 3;
}

// KHR_lights_punctual: clamp(cosine scale + offset)^2, 1 within the inner cone and 0 outside of the outer
// one.
vec4 cone_of(const PunctualLight& light) {
  constexpr double kNarrowest = 0.001;  // of the cosines' difference, as the extension has it
  const double outer = std::cos(double{light.outer_cone_angle});
  const double scale = 1 / std::max(kNarrowest, std::cos(double{light.inner_cone_angle}) - outer);
  return {static_cast<float>(scale), static_cast<float>(-outer * scale), 0, 0};
}

float kind_of(const PunctualLight& light) {
  switch (light.kind) {
    case PunctualLight::Kind::spot:
      return LIGHT_SPOT;
    case PunctualLight::Kind::directional:
      return LIGHT_DIRECTIONAL;
    case PunctualLight::Kind::point:
      break;
  }
  return LIGHT_POINT;
}

}  // namespace

Light pack_punctual(const PunctualLight& light) {
  Light packed{};
  packed.choice.z = kind_of(light);
  packed.centre = vec4(light.position, 0);
  packed.axis = vec4(light.direction, static_cast<float>(mean_intensity(light)));
  packed.intensity = vec4(light.intensity, 1 / light.range);
  packed.cone = cone_of(light);
  return packed;
}

double power_of(const PunctualLight& light, double scene_radius) {
  const double intensity = mean_intensity(light);
  if (light.kind == PunctualLight::Kind::directional) return intensity * scene_radius * scene_radius;
  if (light.kind == PunctualLight::Kind::spot)
    return 2 * intensity * (1 - std::cos(double{light.outer_cone_angle}));
  return 4 * intensity;
}

double typical_radiance(const PunctualLight& light, double scene_radius) {
  // A quarter of the way through the scene.
  const double distance2 = scene_radius * scene_radius / 4;
  const bool is_far = light.kind == PunctualLight::Kind::directional || distance2 <= 0;
  return is_far ? mean_intensity(light) : mean_intensity(light) / distance2;
}

}  // namespace qtrace::gpu
