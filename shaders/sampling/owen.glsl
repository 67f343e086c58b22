// Nested uniform scrambling (Owen 1995) by a hash in which a bit depends on itself and lower ones alone (Laine & Karras
// 2011; the constants: Vegdahl 2021, "Building a Better LK Hash"). The digits come with the first one lowest, as the
// hash needs them, and leave with the first one highest.
uvec4 scrambled(uvec4 reversed, uvec4 seeds) {
  uvec4 x = reversed;
  x ^= x * 0x3d20adeau;
  x += seeds;
  x *= (seeds >> 16u) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return bitfieldReverse(x);
}
