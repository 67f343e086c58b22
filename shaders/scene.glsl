// The scene's buffers.
#include "structs.glsl"
#include "fetch.glsl"

FETCHED_UVEC4(nodes, UNIT_NODES);
FETCHED_VEC4(shapes, UNIT_SHAPES);
FETCHED_VEC4(shades, UNIT_SHADES);
layout(std430, binding = BINDING_MATERIALS) restrict readonly buffer MaterialBuffer { Material materials[]; };
layout(std430, binding = BINDING_LIGHT_TRIANGLES) restrict readonly buffer LightTriangleBuffer {
  LightTriangle light_triangles[];
};
layout(std430, binding = BINDING_LIGHTS) restrict readonly buffer LightBuffer { Light lights[]; };
layout(std140, binding = BINDING_PARAMETERS) uniform ParameterBlock { Parameters parameters; };
layout(location = LOCATION_FRAME) uniform uint frame_number;

// Vertex 0, 1 or 2 of a triangle, and what is stored with it.
vec3 vertex_of(uint triangle, uint vertex) {
  return fetch(shapes, 3u * triangle + vertex).xyz;
}

vec4 shade_of(uint triangle, uint vertex) {
  return fetch(shades, 3u * triangle + vertex);
}

const float PI = 3.14159265358979;
const float INFINITY = uintBitsToFloat(0x7f800000u);

// Set where a loop ended before its own condition: drivers may bound the iterations of a shader
// (llvmpipe: 65,535, shared by all loops). Reported, never ignored.
bool loop_was_cut = false;

float average(vec3 v) {
  return (v.x + v.y + v.z) * (1.0 / 3.0);
}

float max_component(vec3 v) {
  return max(v.x, max(v.y, v.z));
}
