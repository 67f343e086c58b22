// GGX microfacets, and Schlick's reflectance (glTF 2.0, Appendix B).
#include "shared/math.glsl"

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

// Density of the half vectors that visible_normal() draws, per solid angle of the mirrored direction: G1 D max(v.h) /
// (n.v) / (4 v.h), with G1 = 2 n.v / (n.v + sqrt(a^2 + (1 - a^2) n.v^2)).
float visible_reflection_pdf(vec3 n, vec3 wo, vec3 h, float alpha) {
  float n_v = dot(n, wo);
  float a2 = alpha * alpha;
  float masking = 2.0 / (n_v + sqrt(a2 + (1.0 - a2) * n_v * n_v));
  return masking * ggx_distribution(n, h, alpha) * 0.25;
}
