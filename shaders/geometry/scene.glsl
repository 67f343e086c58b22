// The scene's buffers.
#include "shared/fetch.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"

FETCHED_UVEC4(nodes, UNIT_NODES);
FETCHED_VEC4(shapes, UNIT_SHAPES);
FETCHED_VEC4(shades, UNIT_SHADES);
FETCHED_VEC4(materials, UNIT_MATERIALS);
FETCHED_VEC4(light_triangles, UNIT_LIGHT_TRIANGLES);
FETCHED_VEC4(lights, UNIT_LIGHTS);

// Vertex 0, 1 or 2 of a triangle, and what is stored with it.
vec3 vertex_of(uint triangle, uint vertex) {
  return fetch(shapes, 3u * triangle + vertex).xyz;
}

// What a corner has in `shades`: its normal, and what this scene needs of the rest.
#ifdef HAS_TANGENTS
#define TANGENT_VEC4S 1u
#else
#define TANGENT_VEC4S 0u
#endif
#ifdef HAS_COLORS
#define COLOR_VEC4S 1u
#else
#define COLOR_VEC4S 0u
#endif
#if TEXTURES != 0
#define UV_VEC4S 1u
#else
#define UV_VEC4S 0u
#endif
#define CORNER_VEC4S (1u + UV_VEC4S + TANGENT_VEC4S + COLOR_VEC4S)

vec4 shade_of(uint triangle, uint vertex) {
  return fetch(shades, CORNER_VEC4S * (3u * triangle + vertex));
}

vec4 corner_uv(uint triangle, uint vertex) {
  return fetch(shades, CORNER_VEC4S * (3u * triangle + vertex) + 1u);
}

vec4 corner_tangent(uint triangle, uint vertex) {
  return fetch(shades, CORNER_VEC4S * (3u * triangle + vertex) + 1u + UV_VEC4S);
}

vec4 corner_color(uint triangle, uint vertex) {
  return fetch(shades, CORNER_VEC4S * (3u * triangle + vertex) + 1u + UV_VEC4S + TANGENT_VEC4S);
}

// Of corner values, where the second and third count for `b`.
vec4 blended(vec4 v0, vec4 v1, vec4 v2, vec2 b) {
  return (1.0 - b.x - b.y) * v0 + b.x * v1 + b.y * v2;
}

// Members of the structs, by their places in them.
const uint MATERIAL_MEMBERS = 12u;
vec4 material_member(uint material, uint member) { return fetch(materials, MATERIAL_MEMBERS * material + member); }
vec4 base_color_of(uint material) { return material_member(material, 0u); }
vec4 emission_of(uint material) { return material_member(material, 1u); }
vec4 dielectric_f0_of(uint material) { return material_member(material, 2u); }
vec4 roughness_of(uint material) { return material_member(material, 3u); }
vec4 specular_of(uint material) { return material_member(material, 4u); }
vec4 normal_scale_of(uint material) { return material_member(material, 5u); }
vec4 transmission_of(uint material) { return material_member(material, 6u); }
vec4 absorption_of(uint material) { return material_member(material, 7u); }
vec4 coat_of(uint material) { return material_member(material, 8u); }
// The element of `materials` at which the TextureUse of this slot begins; NO_TEXTURE where there is none.
uint texture_use_of(uint material, uint slot) {
  return floatBitsToUint(material_member(material, 9u + slot / 4u))[slot % 4u];
}

const uint LIGHT_MEMBERS = 6u;
vec4 light_member(uint light, uint member) { return fetch(lights, LIGHT_MEMBERS * light + member); }
vec4 light_choice(uint light) { return light_member(light, 0u); }
uvec4 light_link(uint light) { return floatBitsToUint(light_member(light, 1u)); }
vec4 light_centre(uint light) { return light_member(light, 2u); }
vec4 light_axis(uint light) { return light_member(light, 3u); }
vec4 light_intensity(uint light) { return light_member(light, 4u); }
vec4 light_cone(uint light) { return light_member(light, 5u); }

const uint LIGHT_TRIANGLE_MEMBERS = 6u;
LightTriangle light_triangle(uint i) {
  uint first = LIGHT_TRIANGLE_MEMBERS * i;
  return LightTriangle(fetch(light_triangles, first), fetch(light_triangles, first + 1u),
                       fetch(light_triangles, first + 2u), fetch(light_triangles, first + 3u),
                       fetch(light_triangles, first + 4u), floatBitsToUint(fetch(light_triangles, first + 5u)));
}
