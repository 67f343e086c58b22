// The lobes that the BSDF's own sampler keeps, whatever draws the others: mirrors, coats, and what passes through. A
// table of directions about the normal could not hold them: they are narrower than its bins, or lie below the surface.
#include "geometry/surface.glsl"
#include "material/bsdf.glsl"
#include "material/microfacet.glsl"
#include "shared/math.glsl"
#include "shared/variants.glsl"

#ifdef HAS_OWN_LOBES

// Chances that the next direction is drawn by each of them; the rest is the table's lobes'.
struct OwnShares {
  float mirror;
  float through;
  float coat;
};

float sum_of(OwnShares shares) {
  return shares.mirror + shares.through + shares.coat;
}

// By what each lobe sends to the viewer at the mean angle.
OwnShares own_shares(Surface s, Bsdf b, vec3 wo) {
  float n_v = dot(s.normal, wo);
  vec3 dielectric = dielectric_reflectance(b, n_v);
  vec3 metal = schlick(b.base_color, vec3(1.0), n_v);
  float reflected = average(mix(dielectric, metal, b.metallic));
  float entering = (1.0 - b.metallic) * (1.0 - max_component(dielectric)) * average(b.base_color);
  OwnShares shares = OwnShares(b.alpha == 0.0 ? reflected : 0.0, 0.0, 0.0);
  float others = (b.alpha == 0.0 ? 0.0 : reflected) + diffuse_part(b) * entering;
#ifdef HAS_TRANSMISSION
  // Microfacets may let pass what the mean angle reflects in full.
  float least = b.alpha == 0.0 ? 0.0 : 0.05 * (1.0 - b.metallic);
  shares.through = b.transmission * max(entering, least);
  // And reflect in full what it lets pass.
  if (b.far_index < 1.0 && b.alpha > 0.0) others = max(others, 0.05);
#endif
#ifdef HAS_CLEARCOAT
  float below = below_coat(b);
  shares.mirror *= below;
  shares.through *= below;
  others *= below;
  shares.coat = b.coat;
#endif
  float total = sum_of(shares) + others;
  float scale = total > 0.0 ? 1.0 / total : 0.0;
  return OwnShares(shares.mirror * scale, shares.through * scale, shares.coat * scale);
}

bool is_mirror_coat(Bsdf b) {
#ifdef HAS_CLEARCOAT
  return b.coat_alpha == 0.0;
#else
  return true;
#endif
}

// Whether all of its lobes are smooth, from wherever it is seen.
bool is_smooth(Bsdf b) {
  bool has_rough_coat = false;
#ifdef HAS_CLEARCOAT
  has_rough_coat = b.coat > 0.0 && !is_mirror_coat(b);
#endif
  return b.alpha == 0.0 && !has_rough_coat && (b.metallic == 1.0 || diffuse_part(b) == 0.0);
}

#ifdef HAS_TRANSMISSION

// Below the surface as both of its normals see it.
bool passes_into(Surface s, vec3 wi) {
  return dot(s.normal, wi) < 0.0 && dot(s.geometric_normal, wi) < 0.0;
}

// Where the index stays the same, no facet bends the light.
bool passes_one_way(Bsdf b) {
  return b.alpha == 0.0 || (b.bends && b.far_index == 1.0);
}

vec3 passing_color(Bsdf b, float v_h) {
  return (1.0 - b.metallic) * b.transmission * (1.0 - max_component(dielectric_reflectance(b, v_h))) * b.base_color;
}

vec3 mirrored_at_plane(Surface s, vec3 direction) {
  return direction - 2.0 * dot(s.normal, direction) * s.normal;
}

// The microfacet that sends light from wi through to wo, towards the viewer (Walter et al. 2007, equation 16); zero where
// none does. `wi` below the surface.
vec3 passing_facet(Surface s, Bsdf b, vec3 wo, vec3 wi) {
  if (!b.bends) return normalize(wo + mirrored_at_plane(s, wi));
  vec3 h = normalize(b.far_index * wi + wo);
  h = dot(h, s.normal) < 0.0 ? -h : h;
  return dot(wo, h) > 0.0 && dot(wi, h) < 0.0 ? h : vec3(0.0);
}

// Solid angle of facets over that of directions: Walter et al. 2007, equation 17, or that of a reflection.
float facets_per_direction(Bsdf b, float v_h, float l_h) {
  if (!b.bends) return 0.25 / v_h;
  float root = b.far_index * l_h + v_h;
  return b.far_index * b.far_index * abs(l_h) / (root * root);
}

// f_t |cos(theta_i)| of rough surfaces. Radiance in a medium grows with the square of its index (Walter et al. 2007,
// equation 21; Veach 1997, section 5.2), which the denominator has in it.
vec3 through_cosine(Surface s, Bsdf b, vec3 wo, vec3 wi) {
  if (passes_one_way(b) || !passes_into(s, wi)) return vec3(0.0);
  vec3 h = passing_facet(s, b, wo, wi);
  if (h == vec3(0.0)) return vec3(0.0);
  float n_v = dot(s.normal, wo);
  float n_l = -dot(s.normal, wi);
  float v_h = dot(wo, h);
  float l_h = dot(wi, h);
  float lobe = ggx_distribution(s.normal, h, b.alpha) * smith_visibility(n_l, n_v, b.alpha);
  // Of a thin wall the lobe of reflection, mirrored at the surface (KHR_materials_transmission).
  if (b.bends) lobe *= 4.0 * v_h * facets_per_direction(b, v_h, l_h) / (b.far_index * b.far_index);
  return passing_color(b, v_h) * lobe * n_l;
}

float through_pdf(Surface s, Bsdf b, vec3 wo, vec3 wi) {
  if (passes_one_way(b) || dot(s.normal, wi) >= 0.0) return 0.0;
  vec3 h = passing_facet(s, b, wo, wi);
  if (h == vec3(0.0)) return 0.0;
  float v_h = dot(wo, h);
  return visible_reflection_pdf(s.normal, wo, h, b.alpha) * 4.0 * v_h * facets_per_direction(b, v_h, dot(wi, h));
}

// Refracted at a facet, or straight through a thin wall; zero where all is reflected.
vec3 passed_direction(Surface s, Bsdf b, vec3 wo, vec3 facet) {
  if (b.bends) return refract(-wo, facet, 1.0 / b.far_index);
  return mirrored_at_plane(s, reflect(-wo, facet));
}

#endif

#ifdef HAS_CLEARCOAT

bool coat_scatters_into(Surface s, vec3 wi) {
  return dot(s.coat_normal, wi) > 0.0 && dot(s.geometric_normal, wi) > 0.0;
}

float coat_cosine(Surface s, Bsdf b, vec3 wo, vec3 wi) {
  float n_v = dot(s.coat_normal, wo);
  if (is_mirror_coat(b) || b.coat <= 0.0 || n_v <= 0.0 || !coat_scatters_into(s, wi)) return 0.0;
  float n_l = dot(s.coat_normal, wi);
  vec3 h = normalize(wo + wi);
  return b.coat * ggx_distribution(s.coat_normal, h, b.coat_alpha) * smith_visibility(n_l, n_v, b.coat_alpha) * n_l;
}

float coat_pdf(Surface s, Bsdf b, vec3 wo, vec3 wi) {
  if (is_mirror_coat(b) || dot(s.coat_normal, wi) <= 0.0) return 0.0;
  return visible_reflection_pdf(s.coat_normal, wo, normalize(wo + wi), b.coat_alpha);
}

#endif

// f |cos(theta_i)| of the rough ones of them.
vec3 own_lobes_cosine(Surface s, Bsdf b, vec3 wo, vec3 wi) {
  vec3 sum = vec3(0.0);
#ifdef HAS_TRANSMISSION
  sum += through_cosine(s, b, wo, wi) * below_coat(b);
#endif
#ifdef HAS_CLEARCOAT
  sum += coat_cosine(s, b, wo, wi);
#endif
  return sum;
}

// Density of what sample_own_lobes() draws from the rough ones, shares included.
float own_lobes_pdf(Surface s, Bsdf b, vec3 wo, vec3 wi) {
  float sum = 0.0;
#if defined(HAS_TRANSMISSION) || defined(HAS_CLEARCOAT)
  OwnShares shares = own_shares(s, b, wo);
#endif
#ifdef HAS_TRANSMISSION
  if (shares.through > 0.0) sum += shares.through * through_pdf(s, b, wo, wi);
#endif
#ifdef HAS_CLEARCOAT
  if (shares.coat > 0.0) sum += shares.coat * coat_pdf(s, b, wo, wi);
#endif
  return sum;
}

// The directions of smooth lobes have no density. A rough one may draw a direction outside of those that its density tells
// of, which another lobe has: it then counts as one of a smooth lobe that brings nothing.
struct OwnSample {
  vec3 direction;
  bool is_delta;
  vec3 weight;  // of a smooth lobe: f |cos(theta_i)| over its density, its share included
  float compression;  // of radiance: square of the index on the viewer's side over that on the other; 1 for reflections
};

OwnSample sample_mirror(Surface s, Bsdf b, vec3 wo, float share) {
  float n_v = dot(s.normal, wo);
  vec3 color = mix(dielectric_reflectance(b, n_v), schlick(b.base_color, vec3(1.0), n_v), b.metallic);
  vec3 wi = reflect(-wo, s.normal);
  return OwnSample(wi, true, scatters_into(s, wi) ? color * (below_coat(b) / share) : vec3(0.0), 1.0);
}

#ifdef HAS_TRANSMISSION
OwnSample sample_through(Surface s, Bsdf b, vec3 wo, vec2 u, float share) {
  bool one_way = passes_one_way(b);
  vec3 facet = s.normal;
  if (!one_way) facet = facet_normal(s.normal, wo, b.alpha, u);
  vec3 wi = passed_direction(s, b, wo, facet);
  float compression = 1.0 / (b.far_index * b.far_index);
  bool passes = wi != vec3(0.0) && passes_into(s, wi);
  vec3 weight = passing_color(b, dot(wo, facet)) * (below_coat(b) * compression / share);
  return OwnSample(wi, one_way || !passes, passes ? weight : vec3(0.0), compression);
}
#endif

#ifdef HAS_CLEARCOAT
OwnSample sample_coat(Surface s, Bsdf b, vec3 wo, vec2 u, float share) {
  vec3 facet = s.coat_normal;
  if (!is_mirror_coat(b)) facet = facet_normal(s.coat_normal, wo, b.coat_alpha, u);
  vec3 wi = reflect(-wo, facet);
  bool is_above = coat_scatters_into(s, wi);
  return OwnSample(wi, is_mirror_coat(b) || !is_above, is_above ? vec3(b.coat / share) : vec3(0.0), 1.0);
}
#endif

// `u_lobe`: uniform below the sum of the shares.
OwnSample sample_own_lobes(Surface s, Bsdf b, vec3 wo, vec2 u, float u_lobe, OwnShares shares) {
  OwnSample result = sample_mirror(s, b, wo, max(shares.mirror, 1e-30));
#ifdef HAS_TRANSMISSION
  if (u_lobe >= shares.mirror) result = sample_through(s, b, wo, u, max(shares.through, 1e-30));
#endif
#ifdef HAS_CLEARCOAT
  if (u_lobe >= shares.mirror + shares.through) result = sample_coat(s, b, wo, u, max(shares.coat, 1e-30));
#endif
  return result;
}

// What all smooth lobes that lead from wo to wi do together.
struct SmoothLobes {
  vec3 value;         // f |cos(theta_i)|, as a mass
  float probability;  // of drawing one of them
};

// Of two directions that one smooth lobe connects, each follows from the other up to rounding, which refraction near the
// critical angle enlarges: the cosine of the angle between the direction that is asked for and the one that is found.
const float SAME_DIRECTION = 0.9999;

void add_smooth_lobe(inout SmoothLobes sum, OwnSample lobe, float share, vec3 wi) {
  if (!lobe.is_delta || dot(lobe.direction, wi) < SAME_DIRECTION) return;
  sum.value += lobe.weight * share;
  sum.probability += share;
}

SmoothLobes smooth_lobes(Surface s, Bsdf b, vec3 wo, vec3 wi) {
  OwnShares shares = own_shares(s, b, wo);
  SmoothLobes sum = SmoothLobes(vec3(0.0), 0.0);
  if (shares.mirror > 0.0) add_smooth_lobe(sum, sample_mirror(s, b, wo, shares.mirror), shares.mirror, wi);
#ifdef HAS_TRANSMISSION
  if (shares.through > 0.0 && passes_one_way(b))
    add_smooth_lobe(sum, sample_through(s, b, wo, vec2(0.0), shares.through), shares.through, wi);
#endif
#ifdef HAS_CLEARCOAT
  if (shares.coat > 0.0 && is_mirror_coat(b))
    add_smooth_lobe(sum, sample_coat(s, b, wo, vec2(0.0), shares.coat), shares.coat, wi);
#endif
  return sum;
}

#endif

// f |cos(theta_i)| of all lobes that have a density.
vec3 bsdf_cosine(Surface s, Bsdf b, vec3 wo, vec3 wi) {
  vec3 value = table_lobes_cosine(s, b, wo, wi);
#ifdef HAS_OWN_LOBES
  value += own_lobes_cosine(s, b, wo, wi);
#endif
  return value;
}
