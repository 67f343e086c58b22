#include "engine/tracer/table_trial.h"

#include "engine/core/check.h"
#include "engine/tracer/table_gain.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace qtrace {
namespace {

// Of so many times rl.trial_frames frames; each starts where the image has kRoundStarts times as many.
constexpr std::uint32_t kRoundLength = 4;
constexpr std::array<std::uint32_t, 2> kRoundStarts{4, 16};
// How far the radiance that frames without the table find may be from what those with it do: beyond, one of
// them misses light, and its error says nothing.
constexpr double kFoundApart = 0.1;
// Of a search for a cell with what follows from it, in units of a ray: on llvmpipe, frames of the shipped
// scenes say 0.2 to 1.0.
constexpr double kWorkPerLookup = 0.6;
// Standard errors that a gain must be away from its limit.
constexpr double kSure = 2;
// The relative standard error above which the table is not given up yet: where a few blocks have most of the
// error, it is itself uncertain, and a table that is lost costs more than one that is kept.
constexpr double kSharp = 0.1;
// The relative standard error above which a gain says nothing.
constexpr double kBlunt = 0.25;
// What a gain in the pilot may lack, as the table has seen few paths by then.
constexpr double kYoung = 0.9;
// By which power of N a squared error is believed to fall: N^-s, s = 1 for independent samples.
constexpr double kLeastSlope = 1;
constexpr double kMostSlope = 1.5;

constexpr std::size_t kSavedNumbers = 10;
constexpr std::size_t kMostSums = 4;  // of a round, before its end

// Whether a gain is good for giving a table up, given the largest relative standard error for that.
bool tells(const Gain& gain, double largest_error) {
  return std::abs(gain.found - 1) <= kFoundApart && gain.error <= largest_error * gain.value;
}

double work_of(const FrameCounters& counters) {
  return static_cast<double>(counters.rays) + kWorkPerLookup * static_cast<double>(counters.cell_lookups);
}

double work_of(const FrameCounters& with_table, double without) {
  return without > 0 ? work_of(with_table) / without : 1;
}

// Frames of both kinds in turn, in two halves with random numbers of their own.
struct RoundSums {
  const HalfSums &begin, &quarter, &middle, &three_quarters, &end;
  double samples = 0;  // of one kind in a half, times their weight

  // Odd frames (0) or even ones (1).
  TriedFrames halves(std::size_t kind) const {
    return tried(kind, {&begin, &middle}, {&middle, &end}, samples);
  }
  // The same from the first quarter of each half alone.
  TriedFrames quarters(std::size_t kind) const {
    return tried(kind, {&begin, &quarter}, {&middle, &three_quarters}, samples / 2);
  }

 private:
  using Stretch = std::array<const HalfSums*, 2>;

  static TriedFrames tried(std::size_t kind, const Stretch& one, const Stretch& other, double samples) {
    TriedFrames tried;
    const auto mean = [&](const Stretch& of, std::size_t pixel) {
      return (glm::dvec3((*of[1])[kind][pixel]) - glm::dvec3((*of[0])[kind][pixel])) / samples;
    };
    for (std::size_t i = 0; i < (*one[0])[kind].size(); ++i) {
      const glm::dvec3 first = mean(one, i);
      const glm::dvec3 second = mean(other, i);
      tried.mean.push_back((first + second) / 2.0);
      tried.squared_error.push_back((first - second) * (first - second) / 4.0);
    }
    return tried;
  }
};

// The gain that pays for the table's work. With independent samples, as much. With Sobol' points the error
// falls as N^-s without the table, s > 1: fewer frames for the same work lose N^-s, not N^-1; and where the
// sequence starts anew after 1, 2, 4, ... frames, the sum of these nets has the squared error
// Σ L^(2-s) / N^2 = N^-s / (2^(2-s) - 1).
// `halves`: frames without the table, by the halves of `sums`.
double needed_gain(RandomNumbers random, double work, const RoundSums& sums, TriedFrames halves, int width) {
  if (random == RandomNumbers::independent) return work;
  const double ratio = gain_of({sums.quarters(0), std::move(halves)}, width).value;
  const double slope = std::clamp(std::log2(ratio), kLeastSlope, kMostSlope);
  return std::pow(work, slope) / (std::exp2(2 - slope) - 1);
}

template <class T>
void append(std::vector<std::byte>& bytes, std::span<const T> values) {
  const auto from = std::as_bytes(values);
  bytes.insert(bytes.end(), from.begin(), from.end());
}

}  // namespace

TableTrial::TableTrial(const RenderSettings& settings)
    : unit_(settings.sampler == Sampler::rl && !learns_lights(settings)
                ? static_cast<std::uint32_t>(settings.rl.trial_frames)
                : 0),
      random_(settings.random) {}

bool TableTrial::looks_after_pilot(std::uint32_t frame) const {
  return frame > pilot_lessons() && (frame - pilot_lessons()) % unit_ == 0;
}

void TableTrial::look_at_pilot(const PilotLook& seen) {
  check(seen.sums.size() == kMostSums, "the trial of the table has not seen its pilot");
  HalfSums nothing;
  for (auto& half : nothing) half.assign(seen.sums[0][0].size(), glm::vec3(0));
  const RoundSums sums{nothing, seen.sums[0], seen.sums[1], seen.sums[2], seen.sums[3], 1.0 * unit_};
  // Independent samples are replicates each, of which there are more than of halves.
  const auto tried = [&](std::size_t kind) {
    if (random_ != RandomNumbers::independent) return sums.halves(kind);
    return TriedFrames{seen.kinds[kind].mean, seen.kinds[kind].variance};
  };
  std::array<TriedFrames, 2> kinds{tried(0), tried(1)};
  const Gain gain = gain_of(kinds, seen.width);
  const double work = work_of(seen.counters[1], work_of(seen.counters[0]));
  const double needed = needed_gain(random_, work, sums, std::move(kinds[0]), seen.width);
  finding_ = Finding{0, gain.value, gain.error, gain.found, work, needed};
  if (gain.value - kSure * gain.error >= needed) {
    verdict_ = Verdict::keep;
  } else if (tells(gain, kSharp) && gain.value + kSure * gain.error < kYoung * needed) {
    verdict_ = Verdict::give_up;
  }
}

std::array<TableTrial::Round, 2> TableTrial::rounds() const {
  const auto round = [this](std::uint32_t start) {
    const std::uint32_t begin = unit_ * start;
    const std::uint32_t quarter = unit_ * kRoundLength / 4;
    return Round{begin, begin + quarter, begin + 2 * quarter, begin + 3 * quarter, begin + 4 * quarter};
  };
  return {round(kRoundStarts[0]), round(kRoundStarts[1])};
}

bool TableTrial::takes_place(const Round& round) const {
  return is_wanted() && (!is_decided() || round.end <= finding_->frame);
}

bool TableTrial::is_tried(std::uint32_t frame) const {
  return std::ranges::any_of(
      rounds(), [&](const Round& r) { return takes_place(r) && frame > r.begin && frame <= r.end; });
}

bool TableTrial::is_without(std::uint32_t frame) const {
  if (gave_up() && frame > finding_->frame) return true;
  return is_tried(frame) && frame % 2 == 1;
}

std::uint32_t TableTrial::last_boundary(std::uint32_t frame) const {
  std::uint32_t last = 0;
  for (const Round& r : rounds()) {
    if (!takes_place(r)) continue;
    for (const std::uint32_t boundary : {r.begin, r.middle, r.end}) {
      if (boundary <= frame) last = std::max(last, boundary);
    }
  }
  return last;
}

bool TableTrial::looks_after(std::uint32_t frame) const {
  if (!is_wanted() || is_decided()) return false;
  for (const Round& r : rounds()) {
    for (const std::uint32_t wanted : {r.begin, r.quarter, r.middle, r.three_quarters, r.end - 1, r.end}) {
      if (frame == wanted) return true;
    }
  }
  return false;
}

void TableTrial::look(const Look& seen) {
  for (const Round& r : rounds()) {
    if (seen.frame == r.begin) sums_.clear();
    if (seen.frame == r.end - 1) work_without_ = work_of(seen.counters);
    if (seen.frame == r.end) {
      conclude(r, r.end == rounds().back().end, seen);
    } else if (seen.frame >= r.begin && seen.frame < r.end - 1) {
      sums_.push_back(seen.sums);
    }
  }
}

void TableTrial::conclude(const Round& round, bool is_last, const Look& last) {
  check(sums_.size() == kMostSums, "the trial of the table has not seen the frames before {}", last.frame);
  const double samples = static_cast<double>(round.end - round.begin) / 4 * last.weight;
  const RoundSums sums{sums_[0], sums_[1], sums_[2], sums_[3], last.sums, samples};
  std::array<TriedFrames, 2> kinds{sums.halves(0), sums.halves(1)};
  const Gain gain = gain_of(kinds, last.width);
  const double work = work_of(last.counters, work_without_);
  const double needed = needed_gain(random_, work, sums, std::move(kinds[0]), last.width);
  finding_ = Finding{last.frame, gain.value, gain.error, gain.found, work, needed};
  sums_.clear();
  const double most = gain.value + kSure * gain.error;
  if (gain.value >= needed) {
    verdict_ = Verdict::keep;
  } else if (tells(gain, kSharp) && (is_last || most < needed)) {
    verdict_ = Verdict::give_up;
  } else if (is_last) {
    verdict_ = tells(gain, kBlunt) && most < needed ? Verdict::give_up : Verdict::keep;
  }
}

std::vector<std::byte> TableTrial::saved() const {
  const Finding found = finding_.value_or(Finding{});
  const std::array<double, kSavedNumbers> numbers{finding_ ? 1.0 : 0.0, static_cast<double>(found.frame),
                                                  found.gain,           found.gain_error,
                                                  found.found,          found.work,
                                                  found.needed,         static_cast<double>(verdict_),
                                                  work_without_,        static_cast<double>(sums_.size())};
  std::vector<std::byte> bytes;
  append<double>(bytes, numbers);
  for (const HalfSums& sums : sums_) {
    for (const std::vector<glm::vec3>& half : sums) append<glm::vec3>(bytes, half);
  }
  return bytes;
}

void TableTrial::restore(std::span<const std::byte> saved) {
  std::array<double, kSavedNumbers> numbers{};
  constexpr std::size_t kHead = sizeof(numbers);
  const bool has_head = saved.size() >= kHead;
  if (has_head) std::memcpy(numbers.data(), saved.data(), kHead);
  const auto sets = static_cast<std::size_t>(std::clamp(numbers[9], 0.0, 1.0 * kMostSums));
  const std::size_t rest = has_head ? saved.size() - kHead : 0;
  check(has_head && rest % (std::max<std::size_t>(sets, 1) * 2 * sizeof(glm::vec3)) == 0 &&
            (sets > 0 || rest == 0) && numbers[7] >= 0 && numbers[7] <= 2,
        "the state has {} bytes of a trial of the table, which cannot be one", saved.size());
  const auto verdict = static_cast<std::uint32_t>(numbers[7]);
  finding_.reset();
  if (numbers[0] != 0)
    finding_ = Finding{
        static_cast<std::uint32_t>(numbers[1]), numbers[2], numbers[3], numbers[4], numbers[5], numbers[6]};
  verdict_ = static_cast<Verdict>(verdict);
  work_without_ = numbers[8];
  sums_.assign(sets, {});
  const std::byte* from = saved.data() + kHead;
  for (HalfSums& sums : sums_) {
    for (std::vector<glm::vec3>& half : sums) {
      half.resize(rest / (2 * sets) / sizeof(glm::vec3));
      std::memcpy(half.data(), from, half.size() * sizeof(glm::vec3));
      from += half.size() * sizeof(glm::vec3);
    }
  }
}

}  // namespace qtrace
