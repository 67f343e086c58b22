// Points of Sobol's sequence, unscrambled: what is the same for every pixel of a frame.
#pragma once

#include <cstdint>

namespace qtrace {

inline constexpr int kSobolDimensions = 16;

// Coordinate `dimension` (from 0) of point `index`, in 2^-32: the first binary digit is the highest bit.
// Sobol 1967 with the direction numbers of Joe & Kuo 2008, "Constructing Sobol sequences with better
// two-dimensional projections".
std::uint32_t sobol(std::uint32_t index, int dimension);

// The index that takes its place in another block of dimensions: a nested uniform shuffle (Burley 2020,
// "Practical Hash-based Owen Scrambling", JCGT 9(4)), which maps every range [a 2^k, (a + 1) 2^k) onto one of
// its kind.
std::uint32_t shuffled(std::uint32_t index, std::uint32_t seed);

std::uint32_t reversed_bits(std::uint32_t x);

// A bijection of 32 bits in which every bit of the argument changes each of the result with a chance of one
// half (Wellons 2018, "Prospecting for Hash Functions").
std::uint32_t mixed(std::uint32_t x);

}  // namespace qtrace
