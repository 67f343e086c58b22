// What light paths bring to pixels, whichever of them finds which. Summed in integers, so that the order of threads changes
// nothing: two words for each channel, the low one first, in units of SPLAT_UNIT of the brightest light.
#include "shared/counters.glsl"
#include "shared/math.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"

layout(std430, binding = BINDING_SPLATS) restrict coherent buffer SplatBuffer { uint splat_words[]; };

void add_to_words(uint word, float units) {
  float high = floor(units * (1.0 / 4294967296.0));
  uint low = uint(units - high * 4294967296.0);
  uint before = atomicAdd(splat_words[word], low);
  uint carried = uint(high) + (before + low < before ? 1u : 0u);
  if (carried != 0u) atomicAdd(splat_words[word + 1u], carried);
}

void add_splat(uvec2 pixel, vec3 radiance, inout Tally tally) {
  if (!is_finite(radiance.r) || !is_finite(radiance.g) || !is_finite(radiance.b)) {
    report_non_finite(pixel, frame_number);
  } else if (radiance != vec3(0.0)) {
    vec3 units = floor(radiance * (parameters.inverse_brightest / SPLAT_UNIT) + 0.5);
    if (max_component(units) > SPLAT_LIMIT) {
      ++tally.saturated;
      units = min(units, vec3(SPLAT_LIMIT));
    }
    uint first = SPLAT_WORDS * (pixel.y * parameters.image_size.x + pixel.x);
    add_to_words(first, units.r);
    add_to_words(first + 2u, units.g);
    add_to_words(first + 4u, units.b);
  }
}
