#include "engine/tracer/tried_sums.h"

#include "engine/core/check.h"

#include <cstring>
#include <utility>

namespace qtrace {
namespace {

constexpr std::size_t kSavedCounts = 2;

void append(std::vector<std::byte>& bytes, const HalfSums& sums) {
  for (const std::vector<glm::vec3>& kind : sums) {
    const auto from = std::as_bytes(std::span(kind));
    bytes.insert(bytes.end(), from.begin(), from.end());
  }
}

}  // namespace

void TriedSums::start(RandomNumbers random, HalfSums before) {
  random_ = random;
  last_ = std::move(before);
  HalfSums nothing;
  for (auto& kind : nothing) kind.assign(last_[0].size(), glm::vec3(0));
  all_ = marked_ = {0, nothing, nothing};
}

void TriedSums::add(HalfSums sums, const std::array<double, 2>& weights) {
  const bool independent = random_ == RandomNumbers::independent;
  const bool is_first = all_.pairs % 2 == 0;
  for (std::size_t kind = 0; kind < 2; ++kind) {
    for (std::size_t i = 0; i < sums[kind].size(); ++i) {
      const glm::vec3 sample =
          glm::vec3((glm::dvec3(sums[kind][i]) - glm::dvec3(last_[kind][i])) / weights[kind]);
      all_.all[kind][i] += sample;
      if (independent) {
        all_.other[kind][i] += sample * sample;
      } else if (is_first) {
        all_.other[kind][i] += sample;
      }
    }
  }
  ++all_.pairs;
  last_ = std::move(sums);
}

TriedFrames TriedSums::frames(const Sums& sums, std::size_t kind) const {
  TriedFrames frames;
  const double n = sums.pairs;
  for (std::size_t i = 0; i < sums.all[kind].size(); ++i) {
    const glm::dvec3 all(sums.all[kind][i]);
    const glm::dvec3 other(sums.other[kind][i]);
    frames.mean.push_back(all / n);
    if (random_ == RandomNumbers::independent) {
      frames.squared_error.push_back(glm::max(other - all * all / n, 0.0) / (n * (n - 1)));
    } else {
      const glm::dvec3 apart = (2.0 * other - all) / n;  // half the difference of the two means
      frames.squared_error.push_back(apart * apart);
    }
  }
  return frames;
}

std::vector<std::byte> TriedSums::saved() const {
  const std::array<std::uint32_t, kSavedCounts> counts{all_.pairs, marked_.pairs};
  const auto head = std::as_bytes(std::span(counts));
  std::vector<std::byte> bytes(head.begin(), head.end());
  for (const HalfSums* sums : parts(*this)) append(bytes, *sums);
  return bytes;
}

void TriedSums::restore(RandomNumbers random, std::span<const std::byte> saved) {
  const auto own = parts(*this);
  const std::size_t bytes_per_pixel = own.size() * 2 * sizeof(glm::vec3);
  std::array<std::uint32_t, kSavedCounts> counts{};
  const bool is_whole =
      saved.size() >= sizeof(counts) && (saved.size() - sizeof(counts)) % bytes_per_pixel == 0;
  check(is_whole, "the state has {} bytes of the frames that try the table, which cannot be these",
        saved.size());
  std::memcpy(counts.data(), saved.data(), sizeof(counts));
  random_ = random;
  all_.pairs = counts[0];
  marked_.pairs = counts[1];
  const std::byte* from = saved.data() + sizeof(counts);
  const std::size_t pixels = (saved.size() - sizeof(counts)) / bytes_per_pixel;
  for (HalfSums* sums : own) {
    for (std::vector<glm::vec3>& kind : *sums) {
      kind.resize(pixels);
      std::memcpy(kind.data(), from, pixels * sizeof(glm::vec3));
      from += pixels * sizeof(glm::vec3);
    }
  }
}

}  // namespace qtrace
