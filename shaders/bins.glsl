// Direction bins: BINS_THETA x BINS_PHI patches of the hemisphere about a normal, equal in solid angle,
// because they are equal in cos(theta) and in phi. Bin (j, k) has index j * BINS_PHI + k.
const int BINS = BINS_THETA * BINS_PHI;
const float BIN_SOLID_ANGLE = 2.0 * PI / float(BINS);

uint bin_of(vec3 local) {
  float turn = atan(local.y, local.x) * (0.5 / PI);
  turn = turn < 0.0 ? turn + 1.0 : turn;
  uint j = uint(clamp(int(local.z * float(BINS_THETA)), 0, BINS_THETA - 1));
  uint k = uint(clamp(int(turn * float(BINS_PHI)), 0, BINS_PHI - 1));
  return j * uint(BINS_PHI) + k;
}

// The direction at fraction u of the bin's ranges of cos(theta) and phi: uniform for uniform u.
vec3 direction_in_bin(uint bin, vec2 u) {
  float cosine = (float(bin / uint(BINS_PHI)) + u.x) / float(BINS_THETA);
  float phi = 2.0 * PI * (float(bin % uint(BINS_PHI)) + u.y) / float(BINS_PHI);
  float sine = sqrt(max(0.0, 1.0 - cosine * cosine));
  return vec3(sine * cos(phi), sine * sin(phi), cosine);
}
