// The film's sums. In double precision: plain floats stop growing where a sample is below the last place of the sum.
#include "shared/structs.glsl"

PixelSum with_sample(PixelSum sum, vec3 radiance, float weight) {
  dvec3 x = dvec3(radiance);
  dvec3 weighed = double(weight) * x;
  sum.r += weighed.r;
  sum.g += weighed.g;
  sum.b += weighed.b;
  sum.r_squared += weighed.r * x.r;
  sum.g_squared += weighed.g * x.g;
  sum.b_squared += weighed.b * x.b;
  return sum;
}
