// The Q-table's directions as the tracer uses them: their density, and the value that a target bootstraps from.
#include "geometry/surface.glsl"
#include "learning/actions.glsl"
#include "learning/bins.glsl"
#include "learning/cell.glsl"
#include "learning/table.glsl"
#include "material/bsdf.glsl"
#include "shared/fetch.glsl"
#include "shared/loops.glsl"
#include "shared/math.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"

FETCHED_FLOAT(q_values, UNIT_Q_VALUES);
FETCHED_FLOAT(next_values, UNIT_NEXT_VALUES);
FETCHED_FLOAT(bsdf_shares, UNIT_BSDF_SHARES);

Choice choose_bin(uint cell, uint word) {
  return choose_action(first_bin(cell), uint(BINS), word);
}

// Density per solid angle of drawing a bin by its value, then a direction uniformly in it.
float bin_pdf(float probability) {
  return probability / BIN_SOLID_ANGLE;
}

float table_pdf(uint cell, uint bin) {
  return bin_pdf(action_probability(first_bin(cell), uint(BINS), bin));
}

#ifdef HAS_SPECULAR

// Points of the estimate below. Its noise averages out over the targets of a value, as that of the rays does.
const uint EXPECTATION_SAMPLES = 16u;

// The integral of Q f_r cos(theta) over the bins, averaged over the channels, where the BSDF has a lobe that may be
// narrower than a bin: directions drawn from the BSDF itself, at a rank-1 lattice with generator (1, 7, 11) that
// `rotation` shifts (Cranley & Patterson 1976). Its mean over all rotations is the integral.
float expected_reflection(Surface s, Bsdf b, vec3 wo, Cell cell, vec3 rotation) {
  float sum = 0.0;
  uint i = 0u;
  do {
    vec3 u = fract(vec3(float(i), float(i * 7u % EXPECTATION_SAMPLES), float(i * 11u % EXPECTATION_SAMPLES)) /
                       float(EXPECTATION_SAMPLES) + rotation);
    vec3 wi = sample_table_lobes(s, b, wo, u.xy, u.z);
    vec3 reflected = table_lobes_cosine(s, b, wo, wi);
    if (reflected != vec3(0.0)) {
      uint bin = bin_of(to_cell(cell, s.normal, wi));
      sum += fetch_one(q_values, first_bin(uint(cell.index)) + bin) * average(reflected) / table_lobes_pdf(s, b, wo, wi);
    }
    ++i;
  } while (i < EXPECTATION_SAMPLES);
  loop_was_cut = loop_was_cut || i < EXPECTATION_SAMPLES;
  return sum / float(EXPECTATION_SAMPLES);
}

#endif

// What is reflected towards `wo` of the table's radiance: the second term of a target of these rules.
//   expected_sarsa: the integral of Q f_r cos(theta) (Dahm & Keller 2017; Goswami 2020, eq. 18). Lambert: the
//     cell's irradiance, prepared by learn.comp with the exact mean cosine of every bin. Glossy: see above.
//   q_learning: the best bin's value in its place, discounted by the reflectance (Goswami 2020, eq. 13)
//   paper_listing: the best bin's value, discounted by the whole path's throughput (the listing of Goswami 2020)
float next_value(Surface s, Bsdf b, vec3 wo, Cell cell, vec3 throughput, vec3 rotation) {
#if UPDATE_RULE == UPDATE_PAPER_LISTING
  return average(throughput) * fetch_one(next_values, cell.index);
#elif defined(HAS_SPECULAR) && UPDATE_RULE == UPDATE_EXPECTED_SARSA
  return is_lambert(b) ? reflectance(s, b, wo) * fetch_one(next_values, cell.index)
                       : expected_reflection(s, b, wo, cell, rotation);
#else
  return reflectance(s, b, wo) * fetch_one(next_values, cell.index);
#endif
}
