// Emitting triangles, and points on them.
#include "random.glsl"
#include "surface.glsl"

struct LightSample {
  vec3 direction;  // from the surface to the point, unit
  vec3 radiance;   // towards the surface
  float pdf;       // per solid angle, the choice of the light included
  vec3 origin;     // shadow ray: from here ...
  vec3 segment;    // ... to here, over t in (0, 1)
  uint index;
};

// Walker's alias method: one look-up whatever the number of lights. The product of word and count holds the
// slot in its high word and the fraction in its low one, so that no digit serves twice.
uint choose_light(uint word) {
  uint light;
  uint fraction;
  umulExtended(word, parameters.path.z, light, fraction);
  return fraction <= lights[light].link.z ? light : lights[light].link.x;
}

// Density per solid angle, seen from distance `t` under `direction`, of the point sampling below.
float light_pdf(uint light, float t, vec3 direction) {
  float cosine = abs(dot(lights[light].normal.xyz, direction));
  return cosine > 0.0 ? lights[light].edge2.w * t * t / cosine : 0.0;
}

// A point uniform on a chosen triangle; pdf 0 where it cannot send light here.
LightSample sample_light(Surface s, uvec4 bits) {
  uint index = choose_light(bits.x);
  float root = sqrt(to_unit(bits.y));
  float along = to_unit(bits.z);
  vec3 point = lights[index].vertex.xyz + root * (1.0 - along) * lights[index].edge1.xyz +
               root * along * lights[index].edge2.xyz;
  vec3 to_point = point - s.position;
  float t = length(to_point);
  vec3 normal = lights[index].normal.xyz;

  LightSample result;
  result.direction = to_point / t;
  float facing = -dot(normal, result.direction);
  bool lit = t > 0.0 && (facing > 0.0 || (facing < 0.0 && lights[index].radiance.w != 0.0));
  result.radiance = lit ? lights[index].radiance.rgb : vec3(0.0);
  result.pdf = lit ? light_pdf(index, t, result.direction) : 0.0;
  result.origin = ray_origin(s, result.direction);
  // The segment ends off the light on the side that is looked at, by what the test at t = 1 can round off: it
  // grows with the coordinates of either end and with the distance.
  float offset = max(max(lights[index].edge1.w, s.offset), OFFSET_FRACTION * t) * (facing < 0.0 ? -1.0 : 1.0);
  result.segment = point + offset * normal - result.origin;
  result.index = index;
  return result;
}
