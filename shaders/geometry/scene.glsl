// The scene's buffers.
#include "shared/fetch.glsl"
#include "shared/structs.glsl"

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

vec4 shade_of(uint triangle, uint vertex) {
  return fetch(shades, 3u * triangle + vertex);
}

// Members of the structs, by their places in them.
vec4 base_color_of(uint material) { return fetch(materials, 4u * material); }
vec4 emission_of(uint material) { return fetch(materials, 4u * material + 1u); }
vec4 dielectric_f0_of(uint material) { return fetch(materials, 4u * material + 2u); }
float alpha_of(uint material) { return fetch(materials, 4u * material + 3u).x; }

vec4 light_choice(uint light) { return fetch(lights, 4u * light); }
uvec4 light_link(uint light) { return floatBitsToUint(fetch(lights, 4u * light + 1u)); }
vec4 light_centre(uint light) { return fetch(lights, 4u * light + 2u); }
vec4 light_axis(uint light) { return fetch(lights, 4u * light + 3u); }

const uint LIGHT_TRIANGLE_MEMBERS = 6u;
LightTriangle light_triangle(uint i) {
  uint first = LIGHT_TRIANGLE_MEMBERS * i;
  return LightTriangle(fetch(light_triangles, first), fetch(light_triangles, first + 1u),
                       fetch(light_triangles, first + 2u), fetch(light_triangles, first + 3u),
                       fetch(light_triangles, first + 4u), floatBitsToUint(fetch(light_triangles, first + 5u)));
}
