// BSDFs: Lambert, and the metallic-roughness model of glTF 2.0 with its extensions, as in KHR_materials_specular,
// _ior, _transmission, _volume and _clearcoat: a material is
//   mix(base, coat, clearcoat F(0.04, n_coat.v))
//   base = mix(dielectric, F(base colour, v.h) D V, metallic)
//   dielectric = (1 - max F) mix(base colour / pi, base colour * transmitted, transmission) + F D V
// The lobes that a table of directions about the normal holds, diffuse and rough reflection, stand here; those that the
// BSDF's own sampler keeps, in own_lobes.glsl: mirrors and smooth coats, what passes through, and coats. Without
// HAS_SPECULAR every material of the scene is Lambert and nothing else is compiled.
#include "geometry/scene.glsl"
#include "geometry/surface.glsl"
#include "material/microfacet.glsl"
#include "shared/math.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"

struct Bsdf {
  vec3 base_color;
#ifdef HAS_SPECULAR
  float metallic;
  vec4 dielectric_f0;  // w: reflectance at grazing incidence
  float alpha;  // 0 where the reflection is a mirror's
#endif
#ifdef HAS_TRANSMISSION
  float transmission;
  float far_index;  // index of refraction behind the surface over that on the viewer's side; 1 for thin walls
  bool bends;       // whether it bounds a volume
#endif
#ifdef HAS_CLEARCOAT
  float coat;        // how much of it the viewer sees reflect
  float coat_alpha;  // 0 where it is a mirror
#endif
};

#ifdef HAS_SPECULAR

float alpha_of_roughness(float roughness) {
  return roughness < LEAST_ROUGHNESS ? 0.0 : roughness * roughness;
}

void add_gloss(inout Bsdf b, Surface s) {
  b.dielectric_f0 = dielectric_f0_of(s.material);
  vec4 roughness = roughness_of(s.material);
  b.alpha = roughness.x;
#if HAS_TEXTURE(TEXTURE_METALLIC_ROUGHNESS)
  vec4 factors = factor_at(s.material, uint(TEXTURE_METALLIC_ROUGHNESS), s.uv);
  b.metallic *= factors.b;
  b.alpha = alpha_of_roughness(roughness.y * factors.g);
#endif
#if HAS_TEXTURE(TEXTURE_SPECULAR) || HAS_TEXTURE(TEXTURE_SPECULAR_COLOR)
  // KHR_materials_specular.
  vec4 specular = specular_of(s.material);
#if HAS_TEXTURE(TEXTURE_SPECULAR)
  specular.w *= factor_at(s.material, uint(TEXTURE_SPECULAR), s.uv).a;
#endif
#if HAS_TEXTURE(TEXTURE_SPECULAR_COLOR)
  specular.rgb *= factor_at(s.material, uint(TEXTURE_SPECULAR_COLOR), s.uv).rgb;
#endif
  b.dielectric_f0 = vec4(min(specular.rgb, vec3(1.0)) * specular.w, specular.w);
#endif
}

#endif

#ifdef HAS_TRANSMISSION
void add_transmission(inout Bsdf b, Surface s) {
  vec4 factors = transmission_of(s.material);
  b.transmission = factors.x;
#if HAS_TEXTURE(TEXTURE_TRANSMISSION)
  b.transmission *= factor_at(s.material, uint(TEXTURE_TRANSMISSION), s.uv).r;
#endif
  b.bends = factors.y > 0.0;
  b.far_index = !b.bends ? 1.0 : s.back ? 1.0 / factors.y : factors.y;
}
#endif

#ifdef HAS_CLEARCOAT
// KHR_materials_clearcoat: an index of 1.5, seen under the coat's own normal.
void add_coat(inout Bsdf b, Surface s, vec3 wo) {
  vec4 factors = coat_of(s.material);
  b.coat = factors.x;
#if HAS_TEXTURE(TEXTURE_CLEARCOAT)
  b.coat *= factor_at(s.material, uint(TEXTURE_CLEARCOAT), s.uv).r;
#endif
  b.coat *= schlick(vec3(0.04), vec3(1.0), abs(dot(s.coat_normal, wo))).x;
  float roughness = factors.y;
#if HAS_TEXTURE(TEXTURE_CLEARCOAT_ROUGHNESS)
  roughness *= factor_at(s.material, uint(TEXTURE_CLEARCOAT_ROUGHNESS), s.uv).g;
#endif
  b.coat_alpha = alpha_of_roughness(roughness);
}
#endif

// What the texture and the vertices multiply the base colour with.
vec3 base_color_factor(Surface s) {
  vec3 factor = vec3(1.0);
#if HAS_TEXTURE(TEXTURE_BASE_COLOR)
  factor *= factor_at(s.material, uint(TEXTURE_BASE_COLOR), s.uv).rgb;
#endif
#ifdef HAS_COLORS
  factor *= s.color.rgb;
#endif
  return factor;
}

Bsdf bsdf_of(Surface s, vec3 wo) {
  Bsdf b;
  vec4 base = base_color_of(s.material);
  b.base_color = base.rgb * base_color_factor(s);
#ifdef HAS_SPECULAR
  b.metallic = base.w;
  add_gloss(b, s);
#endif
#ifdef HAS_TRANSMISSION
  add_transmission(b, s);
#endif
#ifdef HAS_CLEARCOAT
  add_coat(b, s, wo);
#endif
  return b;
}

// Whether no lobe but a Lambert one is reflected here, besides own lobes.
bool is_lambert(Bsdf b) {
#ifdef HAS_SPECULAR
  return b.metallic == 0.0 && b.dielectric_f0.w == 0.0;
#else
  return true;
#endif
}

vec3 cosine_direction(vec2 u, vec3 normal) {
  float r = sqrt(u.x);
  float phi = 2.0 * PI * u.y;
  vec3 local = vec3(r * cos(phi), r * sin(phi), sqrt(1.0 - u.x));
  return to_world(local, tangent_of(normal), normal);
}

// The hemisphere of directions into which a surface scatters, seen by both of its normals.
bool scatters_into(Surface s, vec3 wi) {
  return dot(s.normal, wi) > 0.0 && dot(s.geometric_normal, wi) > 0.0;
}

#ifdef HAS_SPECULAR

// By Schlick, with the cosine on the side of the lower index; all is reflected where the other side has no direction.
vec3 dielectric_reflectance(Bsdf b, float cosine) {
#ifdef HAS_TRANSMISSION
  if (b.far_index < 1.0) {
    float sine2 = (1.0 - cosine * cosine) / (b.far_index * b.far_index);
    if (sine2 >= 1.0) return vec3(1.0);
    cosine = sqrt(1.0 - sine2);
  }
#endif
  return schlick(b.dielectric_f0.rgb, b.dielectric_f0.www, cosine);
}

// What enters a dielectric and leaves it diffuse, rather than through it.
float diffuse_part(Bsdf b) {
#ifdef HAS_TRANSMISSION
  return 1.0 - b.transmission;
#else
  return 1.0;
#endif
}

// Of what leaves the base, the part that the coat lets pass.
float below_coat(Bsdf b) {
#ifdef HAS_CLEARCOAT
  return 1.0 - b.coat;
#else
  return 1.0;
#endif
}

// Share of samples for the rough reflection: its reflectance at the viewing angle over that of both lobes here.
float specular_share(Bsdf b, float n_v) {
#ifdef HAS_DELTA
  if (b.alpha == 0.0) return 0.0;
#endif
  vec3 dielectric = dielectric_reflectance(b, n_v);
  vec3 metal = schlick(b.base_color, vec3(1.0), n_v);
  float specular = average(mix(dielectric, metal, b.metallic));
  float diffuse = (1.0 - b.metallic) * (1.0 - max_component(dielectric)) * average(b.base_color);
#ifdef HAS_TRANSMISSION
  // A rough surface may reflect all at microfacets although it does not at the mean angle.
  if (b.far_index < 1.0) specular = max(specular, 0.05);
  diffuse *= diffuse_part(b);
#endif
  return specular <= 0.0 ? 0.0 : specular / (specular + diffuse);
}

#endif

// f_r * cos(theta_i) of the lobes here; zero below the surface.
vec3 table_lobes_cosine(Surface s, Bsdf b, vec3 wo, vec3 wi) {
  if (!scatters_into(s, wi)) return vec3(0.0);
  float n_l = dot(s.normal, wi);
#ifdef HAS_SPECULAR
  vec3 h = normalize(wo + wi);
  float v_h = dot(wo, h);
  float lobe = ggx_distribution(s.normal, h, b.alpha) * smith_visibility(n_l, dot(s.normal, wo), b.alpha);
#ifdef HAS_DELTA
  if (b.alpha == 0.0) lobe = 0.0;
#endif
  vec3 dielectric = dielectric_reflectance(b, v_h);
  vec3 metal = schlick(b.base_color, vec3(1.0), v_h);
  vec3 plastic = (1.0 - max_component(dielectric)) * b.base_color / PI + dielectric * lobe;
#ifdef HAS_TRANSMISSION
  plastic = (1.0 - max_component(dielectric)) * diffuse_part(b) * b.base_color / PI + dielectric * lobe;
#endif
#ifdef HAS_CLEARCOAT
  n_l *= below_coat(b);
#endif
  return mix(plastic, metal * lobe, b.metallic) * n_l;
#else
  return b.base_color * (n_l / PI);
#endif
}

// Density of sample_table_lobes() per solid angle.
float table_lobes_pdf(Surface s, Bsdf b, vec3 wo, vec3 wi) {
  float n_l = dot(s.normal, wi);
  if (n_l <= 0.0) return 0.0;
#ifdef HAS_SPECULAR
  float share = specular_share(b, dot(s.normal, wo));
  float specular = share > 0.0 ? visible_reflection_pdf(s.normal, wo, normalize(wo + wi), b.alpha) : 0.0;
  return mix(n_l / PI, specular, share);
#else
  return n_l / PI;
#endif
}

#ifdef HAS_SPECULAR
// A microfacet's normal that the viewer sees.
vec3 facet_normal(vec3 normal, vec3 wo, float alpha, vec2 u) {
  vec3 tangent = tangent_of(normal);
  vec3 wo_local = vec3(dot(wo, tangent), dot(wo, cross(normal, tangent)), dot(wo, normal));
  return to_world(visible_normal(wo_local, alpha, u), tangent, normal);
}
#endif

// A direction in proportion (nearly) to f_r cos(theta) of the lobes here; it may lie below the surface, where f_r is zero.
vec3 sample_table_lobes(Surface s, Bsdf b, vec3 wo, vec2 u, float u_lobe) {
#ifdef HAS_SPECULAR
  if (u_lobe < specular_share(b, dot(s.normal, wo))) return reflect(-wo, facet_normal(s.normal, wo, b.alpha, u));
#endif
  return cosine_direction(u, s.normal);
}

// About how much of the light from anywhere leaves towards the viewer by the lobes here, averaged over the channels: exact
// for Lambert, the reflectance of both lobes at the viewing angle else.
float reflectance(Surface s, Bsdf b, vec3 wo) {
#ifdef HAS_SPECULAR
  float n_v = dot(s.normal, wo);
  vec3 dielectric = dielectric_reflectance(b, n_v);
  vec3 metal = schlick(b.base_color, vec3(1.0), n_v);
#ifdef HAS_OWN_LOBES
  vec3 diffuse = (1.0 - max_component(dielectric)) * diffuse_part(b) * b.base_color;
  vec3 glossy = b.alpha == 0.0 ? vec3(0.0) : mix(dielectric, metal, b.metallic);
  return below_coat(b) * average((1.0 - b.metallic) * diffuse + glossy);
#else
  vec3 plastic = (1.0 - max_component(dielectric)) * b.base_color + dielectric;
  return average(mix(plastic, metal, b.metallic));
#endif
#else
  return average(b.base_color);
#endif
}
