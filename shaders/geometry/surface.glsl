// From a hit to a shading point.
#include "geometry/intersect.glsl"
#include "geometry/normal_map.glsl"
#include "geometry/scene.glsl"
#include "geometry/texture.glsl"
#include "shared/math.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"

struct Surface {
  vec3 position;
  vec3 geometric_normal;  // unit, towards the viewer
  vec3 normal;            // unit shading normal, towards the viewer
  vec3 mesh_normal;       // the shading normal as the mesh has it, out of the front face
  bool back;              // seen from the back face
  uint object;
  uint light;
  uint material;
  float offset;           // length by which rays leave the surface
  vec3 inwards;           // towards the middle of the triangle, about unit length
#if TEXTURES != 0
  vec4 uv;  // xy: set 0, zw: set 1
#endif
#ifdef HAS_COLORS
  vec4 color;  // of its vertices
#endif
#ifdef HAS_CLEARCOAT
  vec3 coat_normal;  // the clearcoat's, as `normal`
#endif
};

// What textures and colours of its vertices need, where the second and third corner count for `b`.
void add_corner_values(inout Surface s, uint triangle, vec2 b) {
#if TEXTURES != 0
  s.uv = blended(corner_uv(triangle, 0u), corner_uv(triangle, 1u), corner_uv(triangle, 2u), b);
#endif
#ifdef HAS_COLORS
  s.color = blended(corner_color(triangle, 0u), corner_color(triangle, 1u), corner_color(triangle, 2u), b);
#endif
}

#ifdef HAS_TANGENTS
// The mesh's normal as the texture of a slot bends it, towards the viewer; as it is where there is no such texture.
vec3 bent_normal(Surface s, Hit hit, vec3 direction, uint slot, float scale) {
  float side = s.back ? -1.0 : 1.0;
  vec3 normal = side * s.mesh_normal;
  uint use = texture_use_of(s.material, slot);
  if (use != NO_TEXTURE) {
    vec4 tangent = blended(corner_tangent(hit.triangle, 0u), corner_tangent(hit.triangle, 1u),
                           corner_tangent(hit.triangle, 2u), hit.barycentric);
    tangent.w = corner_tangent(hit.triangle, 0u).w;
    vec3 bent = mapped_normal(use, s.uv, scale, s.mesh_normal, tangent, side);
    normal = adapted_normal(bent, s.geometric_normal, -direction);
  }
  return normal;
}
#endif

void bend_normals(inout Surface s, Hit hit, vec3 direction) {
#ifdef HAS_CLEARCOAT
  s.coat_normal = s.normal;
#if HAS_TEXTURE(TEXTURE_CLEARCOAT_NORMAL)
  s.coat_normal = bent_normal(s, hit, direction, uint(TEXTURE_CLEARCOAT_NORMAL), normal_scale_of(s.material).y);
#endif
#endif
#if HAS_TEXTURE(TEXTURE_NORMAL)
  s.normal = bent_normal(s, hit, direction, uint(TEXTURE_NORMAL), normal_scale_of(s.material).x);
#endif
}

Surface surface_at(Hit hit, vec3 direction) {
  vec3 v0 = vertex_of(hit.triangle, 0u);
  vec3 v1 = vertex_of(hit.triangle, 1u);
  vec3 v2 = vertex_of(hit.triangle, 2u);
  vec3 edge1 = v1 - v0;
  vec3 edge2 = v2 - v0;
  vec4 n0 = shade_of(hit.triangle, 0u);
  vec4 n1 = shade_of(hit.triangle, 1u);
  vec4 n2 = shade_of(hit.triangle, 2u);
  vec2 b = hit.barycentric;

  Surface s;
  s.position = v0 + b.x * edge1 + b.y * edge2;
  s.material = floatBitsToUint(n0.w);
  s.object = floatBitsToUint(n1.w);
  s.light = floatBitsToUint(n2.w);
  // Scaled first: the product of two edges would leave the range of a float at 1e-19 and 1e19 already.
  float scale = 1.0 / max(max_component(abs(edge1)), max_component(abs(edge2)));
  vec3 face = normalize(cross(edge1 * scale, edge2 * scale));
  s.back = dot(face, direction) > 0.0;
  float side = s.back ? -1.0 : 1.0;
  s.geometric_normal = side * face;
  // Opposite vertex normals can cancel: the tolerance is far below any honest interpolated length.
  vec3 blend = (1.0 - b.x - b.y) * n0.xyz + b.x * n1.xyz + b.y * n2.xyz;
  float blend_length = length(blend);
  s.mesh_normal = blend_length > 1e-6 ? blend / blend_length : face;
  // Where an interpolated normal faces away from the ray, the geometric one is used.
  if (side * dot(s.mesh_normal, direction) >= 0.0) s.mesh_normal = face;
  s.normal = side * s.mesh_normal;
  s.offset = OFFSET_FRACTION * max_component(max(abs(v0), max(abs(v1), abs(v2))));
  s.inwards = scale * ((edge1 + edge2) * (1.0 / 3.0) - (s.position - v0));
  add_corner_values(s, hit.triangle, b);
  bend_normals(s, hit, direction);
  return s;
}

// Where a ray towards `direction` starts: off the surface on the side that it leaves to, and off the triangle's
// edges, where rounding may have put the point on or behind a wall that meets this one there.
vec3 ray_origin(Surface s, vec3 direction) {
  float side = dot(s.geometric_normal, direction) < 0.0 ? -1.0 : 1.0;
  return s.position + s.offset * (side * s.geometric_normal + s.inwards);
}

// Orthonormal basis about n: Duff et al. 2017, "Building an Orthonormal Basis, Revisited", JCGT 6(1).
vec3 tangent_of(vec3 n) {
  float sign_z = n.z < 0.0 ? -1.0 : 1.0;
  float a = -1.0 / (sign_z + n.z);
  return vec3(1.0 + sign_z * n.x * n.x * a, sign_z * n.x * n.y * a, -sign_z * n.x);
}

vec3 to_world(vec3 local, vec3 tangent, vec3 normal) {
  return local.x * tangent + local.y * cross(normal, tangent) + local.z * normal;
}
