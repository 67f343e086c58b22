#include "engine/tracer/sobol.h"

#include <array>
#include <bit>
#include <cstddef>

namespace qtrace {
namespace {

constexpr int kDigits = 32;
using Directions = std::array<std::uint32_t, kDigits>;

// Of dimension 2 and the following ones, as in the file new-joe-kuo-6.21201: the inner coefficients of the
// primitive polynomial as the digits of `a`, and the initial direction numbers, as many as its degree.
struct Polynomial {
  std::uint32_t a;
  int degree;
  std::array<std::uint32_t, 6> m;
};
constexpr std::array<Polynomial, kSobolDimensions - 1> kPolynomials{{{0, 1, {1}},
                                                                     {1, 2, {1, 3}},
                                                                     {1, 3, {1, 3, 1}},
                                                                     {2, 3, {1, 1, 1}},
                                                                     {1, 4, {1, 1, 3, 3}},
                                                                     {4, 4, {1, 3, 5, 13}},
                                                                     {2, 5, {1, 1, 5, 5, 17}},
                                                                     {4, 5, {1, 1, 5, 5, 5}},
                                                                     {7, 5, {1, 1, 7, 11, 19}},
                                                                     {11, 5, {1, 1, 5, 1, 1}},
                                                                     {13, 5, {1, 1, 1, 3, 11}},
                                                                     {14, 5, {1, 3, 5, 5, 31}},
                                                                     {1, 6, {1, 3, 3, 9, 7, 49}},
                                                                     {13, 6, {1, 1, 1, 15, 21, 21}},
                                                                     {16, 6, {1, 3, 1, 13, 27, 49}}}};

constexpr Directions directions_of(const Polynomial& p) {
  Directions v{};
  const auto degree = static_cast<std::size_t>(p.degree);
  for (std::size_t i = 0; i < kDigits; ++i) {
    if (i < degree) {
      v[i] = p.m[i] << (kDigits - 1 - i);
      continue;
    }
    v[i] = v[i - degree] ^ (v[i - degree] >> degree);
    for (std::size_t k = 1; k < degree; ++k) {
      if ((p.a >> (degree - 1 - k) & 1U) != 0) v[i] ^= v[i - k];
    }
  }
  return v;
}

constexpr std::array<Directions, kSobolDimensions> all_directions() {
  std::array<Directions, kSobolDimensions> all{};
  for (std::size_t i = 0; i < kDigits; ++i) all[0][i] = 1U << (kDigits - 1 - i);
  for (std::size_t d = 1; d < all.size(); ++d) all[d] = directions_of(kPolynomials[d - 1]);
  return all;
}
constexpr std::array<Directions, kSobolDimensions> kDirections = all_directions();

}  // namespace

std::uint32_t sobol(std::uint32_t index, int dimension) {
  const Directions& v = kDirections[static_cast<std::size_t>(dimension)];
  std::uint32_t x = 0;
  for (std::uint32_t left = index; left != 0; left &= left - 1) {
    x ^= v[static_cast<std::size_t>(std::countr_zero(left))];
  }
  return x;
}

std::uint32_t mixed(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  return x ^ (x >> 16);
}

std::uint32_t reversed_bits(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x >> 8) & 0x00ff00ffU) | ((x & 0x00ff00ffU) << 8);
  x = ((x >> 4) & 0x0f0f0f0fU) | ((x & 0x0f0f0f0fU) << 4);
  x = ((x >> 2) & 0x33333333U) | ((x & 0x33333333U) << 2);
  return ((x >> 1) & 0x55555555U) | ((x & 0x55555555U) << 1);
}

std::uint32_t shuffled(std::uint32_t index, std::uint32_t seed) {
  // A bit is flipped or not by a hash of all that stand above it.
  std::uint32_t result = index;
  for (int bit = 0; bit < kDigits; ++bit) {
    const std::uint32_t above = bit + 1 < kDigits ? index >> (bit + 1) : 0;
    result ^= (mixed(above ^ mixed(seed + static_cast<std::uint32_t>(bit))) >> 31) << bit;
  }
  return result;
}

}  // namespace qtrace
