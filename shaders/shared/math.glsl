// Numbers and small functions that every room needs.
const float PI = 3.14159265358979;
#define INFINITY uintBitsToFloat(0x7f800000u)

// By the bits: a comparison with NaN may be optimised away.
bool is_finite(float x) {
  return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u;
}

float average(vec3 v) {
  return (v.x + v.y + v.z) * (1.0 / 3.0);
}

float max_component(vec3 v) {
  return max(v.x, max(v.y, v.z));
}
