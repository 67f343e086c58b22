// Lights without a surface: KHR_lights_punctual. No path meets them.
#include "geometry/scene.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"

#ifdef HAS_PUNCTUAL

bool is_punctual(float kind) {
  return kind >= LIGHT_POINT;
}

// From a surface there to the light, or out of the scene where it is directional.
vec3 to_punctual(uint light, float kind, vec3 position) {
  return kind == LIGHT_DIRECTIONAL ? -light_axis(light).xyz * parameters.reach : light_centre(light).xyz - position;
}

// What of its intensity it sends along `direction`, a unit vector away from it.
float punctual_part(uint light, float kind, vec3 direction) {
  if (kind != LIGHT_SPOT) return 1.0;
  vec4 cone = light_cone(light);
  float angular = clamp(dot(light_axis(light).xyz, direction) * cone.x + cone.y, 0.0, 1.0);
  return angular * angular;
}

// And what of that is left at distance `t`, where its range ends it.
float punctual_window(uint light, float kind, float t) {
  if (kind == LIGHT_DIRECTIONAL) return 1.0;
  float part = t * light_intensity(light).w;
  return clamp(1.0 - part * part * part * part, 0.0, 1.0);
}

// Irradiance of a surface that faces it, which sees it at distance `t` under `direction`.
vec3 punctual_irradiance(uint light, float kind, vec3 direction, float t) {
  vec3 intensity = light_intensity(light).rgb;
  if (kind == LIGHT_DIRECTIONAL) return intensity;
  return intensity * (punctual_window(light, kind, t) / (t * t) * punctual_part(light, kind, -direction));
}

#endif
