// Textures, filtered here rather than by the driver: in single precision, and on every device alike.
#include "geometry/scene.glsl"
#include "shared/fetch.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"

#if TEXTURES != 0

FETCHED_HALF4(texels, UNIT_TEXELS);

// The column or row, of `side` in all, that stands for number `i`.
float wrapped(float i, float side, uint mode) {
  float period = mode == WRAP_MIRRORED_REPEAT ? 2.0 * side : side;
  float repeated = i - period * floor(i / period);
  if (repeated >= side) repeated = 2.0 * side - 1.0 - repeated;
  // Rounding may leave the period by one where numbers are large.
  return clamp(mode == WRAP_CLAMP_TO_EDGE ? i : repeated, 0.0, side - 1.0);
}

// `use`: element of its TextureUse. `uv`: xy of set 0, zw of set 1.
vec4 texture_at(uint use, vec4 uv) {
  vec4 u_row = fetch(materials, use);
  vec4 v_row = fetch(materials, use + 1u);
  uvec4 modes = floatBitsToUint(fetch(materials, use + 2u));
  uint first = floatBitsToUint(u_row.w);
  uint size_bits = floatBitsToUint(v_row.w);
  uint width = bitfieldExtract(size_bits, 0, int(TEXTURE_SIDE_BITS)) + 1u;
  uint height = (size_bits >> TEXTURE_SIDE_BITS) + 1u;
  vec3 place = vec3(modes.w == 0u ? uv.xy : uv.zw, 1.0);
  vec2 p = vec2(dot(u_row.xyz, place), dot(v_row.xyz, place));
  if (modes.z != 0u) p = floor(p + 0.5);
  vec2 low = floor(p);
  vec2 part = p - low;
  uint x0 = uint(wrapped(low.x, float(width), modes.x));
  uint x1 = uint(wrapped(low.x + 1.0, float(width), modes.x));
  uint row0 = first + width * uint(wrapped(low.y, float(height), modes.y));
  uint row1 = first + width * uint(wrapped(low.y + 1.0, float(height), modes.y));
  vec4 upper = mix(fetch_half4(texels, row0 + x0), fetch_half4(texels, row0 + x1), part.x);
  vec4 lower = mix(fetch_half4(texels, row1 + x0), fetch_half4(texels, row1 + x1), part.x);
  return mix(upper, lower, part.y);
}

// 1 where the material has no such texture.
vec4 factor_at(uint material, uint slot, vec4 uv) {
  uint use = texture_use_of(material, slot);
  vec4 value = vec4(1.0);
  if (use != NO_TEXTURE) value = texture_at(use, uv);
  return value;
}

#endif
