// How much of a surface there is to be met (glTF 2.0, section 3.9.4: alphaMode).
#include "geometry/surface.glsl"
#include "geometry/texture.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"

// The chance that a ray meets the surface rather than passes it.
float opacity_of(Surface s) {
  float opacity = 1.0;
#ifdef HAS_ALPHA
  vec4 roughness = roughness_of(s.material);
  opacity = roughness.z;
#if HAS_TEXTURE(TEXTURE_BASE_COLOR)
  opacity *= factor_at(s.material, uint(TEXTURE_BASE_COLOR), s.uv).a;
#endif
#ifdef HAS_COLORS
  opacity *= s.color.a;
#endif
  float cutoff = roughness.w;
  if (cutoff >= 0.0) opacity = opacity >= cutoff ? 1.0 : 0.0;
  if (cutoff == ALPHA_OPAQUE) opacity = 1.0;
#endif
  return opacity;
}
