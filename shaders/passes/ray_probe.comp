#version 450 core
// Ray queries as paths make them, in a room of its own: what is measured to choose how shaders are compiled for a driver
// (engine/device_scene/driver_measurement.h).
#include "geometry/traverse.glsl"
#include "shared/work_groups.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = BINDING_OUTPUT) restrict writeonly buffer AnswerBuffer { uint answers[]; };

uint next_random(inout uint state) {
  state = state * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
  return (word >> 22) ^ word;
}

vec3 random_point(inout uint state) {
  return vec3(next_random(state), next_random(state), next_random(state)) * (1.0 / 4294967296.0);
}

void main() {
  uint index = dealt_group() * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  uint state = index;
  vec3 origin = random_point(state);
  uint answer = 0u;
  for (uint event = 0u; event < 2u; ++event) {
    vec3 direction = random_point(state) - 0.5;
    Hit hit = closest_hit(origin, direction);
    bool missed = hit.triangle == NO_TRIANGLE;
    origin = missed ? random_point(state) : origin + 0.99 * hit.t * direction;
    bool hidden = is_occluded(origin, random_point(state) - origin);
    answer = answer * 31u + (missed ? 0u : floatBitsToUint(hit.t)) + (hidden ? 1u : 0u);
  }
  answers[index] = answer;
}
