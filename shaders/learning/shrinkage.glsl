// Values of bins as the table uses them: shrunk towards those around them where they have few visits of their own.
#include "learning/bins.glsl"
#include "learning/storage.glsl"
#include "shared/parameters.glsl"

#ifdef SHRINKS

// Blocks of bins, a quarter of the square's side wide and high: enough to tell the sides of a room apart, and few enough
// to be known after some frames.
const uint BLOCKS_ALONG = 4u;
const uint BLOCKS = BLOCKS_ALONG * BLOCKS_ALONG;

uint block_of(uint bin) {
  uvec2 place = uvec2(bin / uint(BINS_PHI), bin % uint(BINS_PHI)) * BLOCKS_ALONG / uvec2(BINS_THETA, BINS_PHI);
  return place.x * BLOCKS_ALONG + place.y;
}

// Empirical Bayes (Efron & Morris 1973): a bin with few visits is pulled towards the mean of its block, and a block
// towards the mean of its cell. Means over bins count each by how far it stands on its own, so that a bin that is
// visited often because it is bright does not stand for its neighbours.
float block_means[BLOCKS];

void find_block_means(uint first) {
  float sums[BLOCKS], weights[BLOCKS], visits[BLOCKS];
  uint i = 0u;
  do {
    sums[i] = weights[i] = visits[i] = 0.0;
    ++i;
  } while (i < BLOCKS);
  i = 0u;
  do {
    float n = float(q_visits[first + i]);
    float weight = n / (n + parameters.shrinkage);
    uint block = block_of(i);
    sums[block] += weight * q_values[first + i];
    weights[block] += weight;
    visits[block] += n;
    ++i;
  } while (i < uint(BINS));
  float sum = 0.0;
  float weight = 0.0;
  i = 0u;
  do {
    sum += sums[i];
    weight += weights[i];
    ++i;
  } while (i < BLOCKS);
  float mean = weight > 0.0 ? sum / weight : 0.0;
  i = 0u;
  do {
    float own = weights[i] > 0.0 ? sums[i] / weights[i] : 0.0;
    block_means[i] = mix(mean, own, visits[i] / (visits[i] + parameters.shrinkage));
    ++i;
  } while (i < BLOCKS);
}

float shrunk(uint first, uint bin) {
  float n = float(q_visits[first + bin]);
  return mix(block_means[block_of(bin)], q_values[first + bin], n / (n + parameters.shrinkage));
}

#else

void find_block_means(uint first) {}

float shrunk(uint first, uint bin) {
  return q_values[first + bin];
}

#endif
