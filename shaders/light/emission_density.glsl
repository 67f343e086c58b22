// Densities with which light paths start (start.glsl): the light is chosen as where nothing is learned, then a point on it and
// a direction; of what is far away, a direction and a point of a disk across the scene that faces it.
#include "geometry/scene.glsl"
#include "shared/math.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"

#ifdef HAS_LIGHT_PATHS

// Of the choice of a light; the rest is the constant environment's.
float emission_choice(uint light) {
  return (1.0 - parameters.environment_share) * light_choice(light).x;
}

float emitting_side(LightTriangle triangle) {
  return triangle.radiance.w == EMITS_FRONT ? 1.0 : 0.5;
}

// Per solid angle, where `cosine` is that of the direction with the triangle's normal.
float lamp_direction_pdf(LightTriangle triangle, float cosine) {
  return emitting_side(triangle) * abs(cosine) / PI;
}

#ifdef HAS_PUNCTUAL
// The cosine of a spot's outer angle.
float spot_end(uint light) {
  vec4 cone = light_cone(light);
  return -cone.y / cone.x;
}

// Per solid angle, uniform over all directions or over the spot's cone.
float punctual_direction_pdf(uint light, float kind) {
  return kind == LIGHT_SPOT ? 0.5 / (PI * (1.0 - spot_end(light))) : 0.25 / PI;
}
#endif

// Of a light path that leaves a point of a lamp, per area and solid angle, over the cosine there.
float lamp_emission_pdf(LightTriangle triangle) {
  return emission_choice(triangle.link.y) * triangle.edge2.w * emitting_side(triangle) / PI;
}

#endif
