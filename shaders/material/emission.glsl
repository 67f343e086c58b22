// What surfaces emit.
#include "geometry/surface.glsl"
#include "geometry/texture.glsl"
#include "material/bsdf.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"

// Radiance that the surface emits towards the viewer that `b` is for; from the front face, unless double-sided.
vec3 emitted_radiance(Surface s, Bsdf b) {
  vec4 emission = emission_of(s.material);
#if HAS_TEXTURE(TEXTURE_EMISSION)
  emission.rgb *= factor_at(s.material, uint(TEXTURE_EMISSION), s.uv).rgb;
#endif
#ifdef HAS_CLEARCOAT
  // The coat lies over what emits as well.
  emission.rgb *= below_coat(b);
#endif
#ifdef HAS_UNLIT
  // KHR_materials_unlit: its base colour, which no coat has anything to do with.
  if (emission.w == EMITS_UNLIT) emission.rgb = emission_of(s.material).rgb * base_color_factor(s);
#endif
  return s.back && emission.w == EMITS_FRONT ? vec3(0.0) : emission.rgb;
}
