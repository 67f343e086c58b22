// The film's sums. In double precision: plain floats stop growing where a sample is below the last place of the sum.
#include "shared/structs.glsl"

PixelSum with_sample(PixelSum sum, vec3 radiance) {
  dvec3 x = dvec3(radiance);
  sum.r += x.r;
  sum.g += x.g;
  sum.b += x.b;
  sum.r_squared += x.r * x.r;
  sum.g_squared += x.g * x.g;
  sum.b_squared += x.b * x.b;
  return sum;
}
