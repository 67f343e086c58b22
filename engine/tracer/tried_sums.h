// What frames of two kinds brought, pair by pair, and how far their replicates lie apart.
#pragma once

#include "engine/core/settings.h"
#include "engine/tracer/table_gain.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace qtrace {

// Sums over the odd and over the even frames so far, pixel by pixel.
using HalfSums = std::array<std::vector<glm::vec3>, 2>;

// Odd frames are of the first kind, even ones of the second. Independent samples are replicates each. Of
// Sobol' points, every other pair belongs to the first of two sequences, and those between to the second.
class TriedSums {
 public:
  // Nothing tried so far. `before`: what the frames before the first pair sum up to.
  void start(RandomNumbers random, HalfSums before);
  // After a pair: the sums now, and what its two frames weigh in them.
  void add(HalfSums sums, const std::array<double, 2>& weights);
  // Keeps what `halfway` gives later.
  void mark() { marked_ = all_; }

  std::uint32_t pairs() const { return all_.pairs; }
  // Of a kind, 0 or 1. Two pairs at least.
  TriedFrames frames(std::size_t kind) const { return frames(all_, kind); }
  TriedFrames halfway(std::size_t kind) const { return frames(marked_, kind); }  // up to the mark

  // To go on with later.
  std::vector<std::byte> saved() const;
  void restore(RandomNumbers random, std::span<const std::byte> saved);  // throws Error where it is none

 private:
  struct Sums {
    std::uint32_t pairs = 0;
    HalfSums all;    // of the samples of each kind
    HalfSums other;  // of their squares; with Sobol' points, of those of the first sequence
  };
  TriedFrames frames(const Sums& sums, std::size_t kind) const;
  // What is saved beside the counts, in this order. `self`: const or not.
  static auto parts(auto& self) {
    return std::array{&self.last_, &self.all_.all, &self.all_.other, &self.marked_.all, &self.marked_.other};
  }

  RandomNumbers random_ = RandomNumbers::independent;
  HalfSums last_;
  Sums all_, marked_;
};

}  // namespace qtrace
