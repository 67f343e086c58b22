// glTF 2.0 metallic-roughness (specification, Appendix B) with KHR_materials_specular.
// Without HAS_SPECULAR every material of the scene is Lambert and nothing else is compiled.
#include "geometry/scene.glsl"
#include "geometry/surface.glsl"
#include "shared/math.glsl"

struct Bsdf {
  vec3 base_color;
#ifdef HAS_SPECULAR
  float metallic;
  vec4 dielectric_f0;  // w: reflectance at grazing incidence
  float alpha;
#endif
};

Bsdf bsdf_of(Surface s) {
  Bsdf b;
  vec4 base = base_color_of(s.material);
#if HAS_TEXTURE(TEXTURE_BASE_COLOR)
  base.rgb *= factor_at(s.material, uint(TEXTURE_BASE_COLOR), s.uv).rgb;
#endif
#ifdef HAS_COLORS
  base.rgb *= s.color.rgb;
#endif
  b.base_color = base.rgb;
#ifdef HAS_SPECULAR
  b.metallic = base.w;
  b.dielectric_f0 = dielectric_f0_of(s.material);
  vec4 roughness = roughness_of(s.material);
  b.alpha = roughness.x;
#if HAS_TEXTURE(TEXTURE_METALLIC_ROUGHNESS)
  vec4 factors = factor_at(s.material, uint(TEXTURE_METALLIC_ROUGHNESS), s.uv);
  b.metallic *= factors.b;
  float rough = max(roughness.y * factors.g, LEAST_ROUGHNESS);
  b.alpha = rough * rough;
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
#endif
  return b;
}

// Whether nothing but the Lambert lobe is there.
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
vec3 schlick(vec3 f0, vec3 f90, float cosine) {
  float m = clamp(1.0 - cosine, 0.0, 1.0);
  float m2 = m * m;
  return f0 + (f90 - f0) * (m2 * m2 * m);
}

// GGX with 1 - (n.h)^2 as |n x h|^2, which keeps its digits where the lobe is narrow.
float ggx_distribution(vec3 n, vec3 h, float alpha) {
  vec3 c = cross(n, h);
  float a = alpha * dot(n, h);
  float k = alpha / (dot(c, c) + a * a);
  return k * k / PI;
}

// Height-correlated Smith masking-shadowing over 4 |n.l| |n.v| (Appendix B, V_GGX).
float smith_visibility(float n_l, float n_v, float alpha) {
  float a2 = alpha * alpha;
  float ggx_v = n_l * sqrt(n_v * n_v * (1.0 - a2) + a2);
  float ggx_l = n_v * sqrt(n_l * n_l * (1.0 - a2) + a2);
  return 0.5 / (ggx_v + ggx_l);
}

// Share of samples for the specular lobe: its reflectance at the viewing angle over that of both lobes.
float specular_share(Bsdf b, float n_v) {
  vec3 dielectric = schlick(b.dielectric_f0.rgb, b.dielectric_f0.www, n_v);
  vec3 metal = schlick(b.base_color, vec3(1.0), n_v);
  float specular = average(mix(dielectric, metal, b.metallic));
  float diffuse = (1.0 - b.metallic) * (1.0 - max_component(dielectric)) * average(b.base_color);
  return specular <= 0.0 ? 0.0 : specular / (specular + diffuse);
}

// Distribution of visible normals: Heitz 2018, "Sampling the GGX Distribution of Visible Normals", JCGT 7(4).
vec3 visible_normal(vec3 wo_local, float alpha, vec2 u) {
  vec3 v = normalize(vec3(alpha * wo_local.xy, wo_local.z));
  float length2 = dot(v.xy, v.xy);
  vec3 t1 = length2 > 0.0 ? vec3(-v.y, v.x, 0.0) * inversesqrt(length2) : vec3(1.0, 0.0, 0.0);
  vec3 t2 = cross(v, t1);
  float r = sqrt(u.x);
  float phi = 2.0 * PI * u.y;
  float p1 = r * cos(phi);
  float s = 0.5 * (1.0 + v.z);
  float p2 = mix(sqrt(max(0.0, 1.0 - p1 * p1)), r * sin(phi), s);
  vec3 n = p1 * t1 + p2 * t2 + sqrt(max(0.0, 1.0 - p1 * p1 - p2 * p2)) * v;
  return normalize(vec3(alpha * n.xy, max(0.0, n.z)));
}

float visible_normal_reflection_pdf(Surface s, Bsdf b, vec3 wo, vec3 wi) {
  vec3 h = normalize(wo + wi);
  float n_v = dot(s.normal, wo);
  float a2 = b.alpha * b.alpha;
  // G1 D max(v.h) / (n.v) / (4 v.h), with G1 = 2 n.v / (n.v + sqrt(a^2 + (1 - a^2) n.v^2)).
  float masking = 2.0 / (n_v + sqrt(a2 + (1.0 - a2) * n_v * n_v));
  return masking * ggx_distribution(s.normal, h, b.alpha) * 0.25;
}
#endif

// f_r * cos(theta_i); zero below the surface.
vec3 bsdf_cosine(Surface s, Bsdf b, vec3 wo, vec3 wi) {
  if (!scatters_into(s, wi)) return vec3(0.0);
  float n_l = dot(s.normal, wi);
#ifdef HAS_SPECULAR
  vec3 h = normalize(wo + wi);
  float v_h = dot(wo, h);
  float lobe = ggx_distribution(s.normal, h, b.alpha) * smith_visibility(n_l, dot(s.normal, wo), b.alpha);
  vec3 dielectric = schlick(b.dielectric_f0.rgb, b.dielectric_f0.www, v_h);
  vec3 metal = schlick(b.base_color, vec3(1.0), v_h);
  vec3 plastic = (1.0 - max_component(dielectric)) * b.base_color / PI + dielectric * lobe;
  return mix(plastic, metal * lobe, b.metallic) * n_l;
#else
  return b.base_color * (n_l / PI);
#endif
}

// Density of sample_bsdf() per solid angle.
float bsdf_pdf(Surface s, Bsdf b, vec3 wo, vec3 wi) {
  float n_l = dot(s.normal, wi);
  if (n_l <= 0.0) return 0.0;
#ifdef HAS_SPECULAR
  float share = specular_share(b, dot(s.normal, wo));
  float specular = share > 0.0 ? visible_normal_reflection_pdf(s, b, wo, wi) : 0.0;
  return mix(n_l / PI, specular, share);
#else
  return n_l / PI;
#endif
}

// A direction in proportion (nearly) to f_r cos(theta); it may lie below the surface, where f_r is zero.
vec3 sample_bsdf(Surface s, Bsdf b, vec3 wo, vec2 u, float u_lobe) {
#ifdef HAS_SPECULAR
  if (u_lobe < specular_share(b, dot(s.normal, wo))) {
    vec3 tangent = tangent_of(s.normal);
    vec3 wo_local = vec3(dot(wo, tangent), dot(wo, cross(s.normal, tangent)), dot(wo, s.normal));
    vec3 h = to_world(visible_normal(wo_local, b.alpha, u), tangent, s.normal);
    return reflect(-wo, h);
  }
#endif
  return cosine_direction(u, s.normal);
}

// About how much of the light from anywhere leaves towards the viewer, averaged over the channels: exact for
// Lambert, the reflectance of both lobes at the viewing angle else.
float reflectance(Surface s, Bsdf b, vec3 wo) {
#ifdef HAS_SPECULAR
  float n_v = dot(s.normal, wo);
  vec3 dielectric = schlick(b.dielectric_f0.rgb, b.dielectric_f0.www, n_v);
  vec3 plastic = (1.0 - max_component(dielectric)) * b.base_color + dielectric;
  return average(mix(plastic, schlick(b.base_color, vec3(1.0), n_v), b.metallic));
#else
  return average(b.base_color);
#endif
}
