// Shading normals bent by a texture (glTF 2.0, section 3.9.3).
#include "geometry/texture.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"

#ifdef HAS_TANGENTS

// A mirrored ray leaves the surface by at least this cosine.
const float LEAST_MIRRORED_COSINE = 1e-3;

// A bent normal may send the mirrored ray below the surface. It is turned as far as keeps that ray above: Keller et al.
// 2017, "The Iray Light Transport Simulation and Rendering System", section A.3. `face` and `wo` on one side.
vec3 adapted_normal(vec3 normal, vec3 face, vec3 wo) {
  vec3 mirrored = 2.0 * dot(normal, wo) * normal - wo;
  float above = dot(mirrored, face);
  vec3 raised = normalize(mirrored + max(LEAST_MIRRORED_COSINE - above, 0.0) * face);
  bool is_kept = above >= LEAST_MIRRORED_COSINE && dot(normal, wo) > 0.0;
  return is_kept ? normal : normalize(wo + raised);
}

// `normal`: of the mesh, out of its front face. `tangent`: w as in TriangleAttributes (engine/scene/scene.h).
// `side`: 1 for the front face, -1 for the back. The result is on that side.
vec3 mapped_normal(uint use, vec4 uv, float scale, vec3 normal, vec4 tangent, float side) {
  // The texels are 2 c - 1 already.
  vec3 local = texture_at(use, uv).xyz * vec3(scale, scale, 1.0);
  vec3 t = tangent.xyz - dot(tangent.xyz, normal) * normal;
  float length2 = dot(t, t);
  t = length2 > 0.0 ? t * inversesqrt(length2) : vec3(0.0);
  vec3 bent = local.x * t + local.y * (tangent.w * cross(normal, t)) + local.z * normal;
  float bent2 = dot(bent, bent);
  return side * (bent2 > 0.0 ? bent * inversesqrt(bent2) : normal);
}

#endif
