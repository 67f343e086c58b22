#include "engine/tracer/table_trial.h"

#include "engine/core/check.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace qtrace {
namespace {

constexpr int kRounds = 3;
// Each round is so many times as long as the one before, and starts after as many frames as it has.
constexpr std::uint32_t kGrowth = 4;
// Keeps relative errors of dark pixels finite (the metrics' relMSE has the same); radiance squared.
constexpr double kDark = 0.01;
// A pixel's own mean of so few samples would hide what is rare and bright behind itself: means are of square
// blocks.
constexpr std::size_t kBlock = 8;  // pixels along a side
// Of the blocks, those with the largest errors: a bright sample alone shall not decide.
constexpr double kTrimmedShare = 0.02;
// Of the radiance that frames with the table find, what those without it must find for their error to count.
constexpr double kFoundShare = 0.9;
// Of a search for a cell with what follows from it, in units of a ray: on llvmpipe, frames of the shipped
// scenes say 0.2 to 1.0.
constexpr double kWorkPerLookup = 0.6;
// Standard errors that a gain must be away from its limit.
constexpr double kSure = 2;
// The relative standard error above which the table is not given up yet: where a few blocks have most of the
// error, it is itself uncertain, and a table that is lost costs more than one that is kept.
constexpr double kSharp = 0.08;
// What a gain in the first round may lack, as the table has seen few frames by then.
constexpr double kYoung = 0.9;

constexpr std::size_t kSavedNumbers = 9;

double work_of(const FrameCounters& counters) {
  return static_cast<double>(counters.rays) + kWorkPerLookup * static_cast<double>(counters.cell_lookups);
}

// Without the table, and with it.
using Kinds = std::array<double, 2>;

struct Block {
  glm::dvec3 mean{0};  // of both
  double pixels = 0;
  Kinds found{};  // radiance
  Kinds errors{};
};

// Means of one half of a round, over the frames of one kind (0: without the table, 1: with it).
struct Replicates {
  const HalfSums &begin, &middle, &end;
  double samples = 0;  // of one kind in one half, times their weight

  glm::dvec3 first(std::size_t kind, std::size_t pixel) const {
    return (middle[kind][pixel] - begin[kind][pixel]) / samples;
  }
  glm::dvec3 second(std::size_t kind, std::size_t pixel) const {
    return (end[kind][pixel] - middle[kind][pixel]) / samples;
  }
};

std::vector<Block> blocks_of(const Replicates& round, std::size_t width) {
  const std::size_t pixels = round.begin[0].size();
  const std::size_t across = width / kBlock + 1;
  const auto block_of = [&](std::size_t i) { return i / width / kBlock * across + i % width / kBlock; };
  std::vector<Block> blocks(pixels == 0 ? 0 : block_of(pixels - 1) / across * across + across);
  for (std::size_t i = 0; i < pixels; ++i) {
    Block& block = blocks[block_of(i)];
    ++block.pixels;
    for (std::size_t kind = 0; kind < 2; ++kind) {
      const glm::dvec3 sum = round.first(kind, i) + round.second(kind, i);
      block.mean += sum / 4.0;
      block.found[kind] += sum.r + sum.g + sum.b;
    }
  }
  for (std::size_t i = 0; i < pixels; ++i) {
    Block& block = blocks[block_of(i)];
    const glm::dvec3 mean = block.mean / block.pixels;
    for (std::size_t kind = 0; kind < 2; ++kind) {
      const glm::dvec3 difference = round.first(kind, i) - round.second(kind, i);
      const glm::dvec3 relative = difference * difference / (mean * mean + kDark);
      block.errors[kind] += relative.r + relative.g + relative.b;
    }
  }
  std::erase_if(blocks, [](const Block& block) { return block.pixels == 0; });
  return blocks;
}

struct Gain {
  double value = 1;
  double error = 0;
  double found = 1;  // of the radiance with the table, without it
};

// The ratio of sums over blocks, and its error by linearisation (Cochran 1977, "Sampling Techniques",
// section 6.3).
Gain gain_of(std::vector<Block> blocks) {
  const bool is_even =
      std::ranges::all_of(blocks, [](const Block& b) { return b.errors[0] == 0 && b.errors[1] == 0; });
  std::ranges::sort(blocks, {}, [](const Block& b) { return std::max(b.errors[0], b.errors[1]); });
  const auto trimmed =
      static_cast<std::size_t>(std::ceil(kTrimmedShare * static_cast<double>(blocks.size())));
  blocks.resize(blocks.size() - std::min(trimmed, blocks.size()));
  Kinds sums{}, found{};
  for (const Block& block : blocks) {
    for (std::size_t kind = 0; kind < 2; ++kind) {
      sums[kind] += block.errors[kind];
      found[kind] += block.found[kind];
    }
  }
  // Few blocks alone have errors: these say nothing of the others.
  if (sums[1] == 0) return {1, is_even ? 0 : std::numeric_limits<double>::infinity(), 1};
  Gain gain{sums[0] / sums[1], 0, found[1] > 0 ? found[0] / found[1] : 1};
  for (const Block& block : blocks) {
    const double residual = block.errors[0] - gain.value * block.errors[1];
    gain.error += residual * residual;
  }
  gain.error = std::sqrt(gain.error) / sums[1];
  return gain;
}

template <class T>
void append(std::vector<std::byte>& bytes, std::span<const T> values) {
  const auto from = std::as_bytes(values);
  bytes.insert(bytes.end(), from.begin(), from.end());
}

}  // namespace

TableTrial::TableTrial(const RenderSettings& settings)
    : first_round_(settings.sampler == Sampler::rl && !learns_lights(settings)
                       ? static_cast<std::uint32_t>(settings.rl.trial_frames)
                       : 0) {}

TableTrial::Round TableTrial::round(int number) const {
  std::uint32_t length = first_round_;
  for (int i = 0; i < number; ++i) length *= kGrowth;
  return {length, length + length / 2, 2 * length};
}

bool TableTrial::takes_place(const Round& round) const {
  return is_wanted() && (!is_decided() || round.end <= finding_->frame);
}

std::optional<TableTrial::Round> TableTrial::round_of(std::uint32_t frame) const {
  for (int number = 0; number < kRounds; ++number) {
    const Round r = round(number);
    if (takes_place(r) && frame > r.begin && frame <= r.end) return r;
  }
  return std::nullopt;
}

bool TableTrial::is_tried(std::uint32_t frame) const { return round_of(frame).has_value(); }

bool TableTrial::is_without(std::uint32_t frame) const {
  if (gave_up() && frame > finding_->frame) return true;
  return is_tried(frame) && frame % 2 == 1;
}

std::uint32_t TableTrial::last_boundary(std::uint32_t frame) const {
  std::uint32_t last = 0;
  for (int number = 0; number < kRounds; ++number) {
    const Round r = round(number);
    if (!takes_place(r)) continue;
    for (const std::uint32_t boundary : {r.begin, r.middle, r.end}) {
      if (boundary <= frame) last = std::max(last, boundary);
    }
  }
  return last;
}

bool TableTrial::looks_after(std::uint32_t frame) const {
  if (!is_wanted() || is_decided()) return false;
  for (int number = 0; number < kRounds; ++number) {
    const Round r = round(number);
    if (frame == r.begin || frame == r.middle || frame == r.end - 1 || frame == r.end) return true;
  }
  return false;
}

void TableTrial::look(const Look& seen) {
  for (int number = 0; number < kRounds; ++number) {
    const Round r = round(number);
    if (seen.frame == r.begin) sums_ = {seen.sums};
    if (seen.frame == r.middle) sums_.push_back(seen.sums);
    if (seen.frame == r.end - 1) work_without_ = work_of(seen.counters);
    if (seen.frame == r.end) conclude(r, number, seen);
  }
}

void TableTrial::conclude(const Round& round, int number, const Look& last) {
  check(sums_.size() == 2, "the trial of the table has not seen the frames before {}", last.frame);
  const double samples = static_cast<double>(round.end - round.begin) / 4 * last.weight;
  const Replicates replicates{sums_[0], sums_[1], last.sums, samples};
  const Gain gain = gain_of(blocks_of(replicates, static_cast<std::size_t>(last.width)));
  const double work = work_without_ > 0 ? work_of(last.counters) / work_without_ : 1;
  finding_ = Finding{last.frame, gain.value, gain.error, gain.found, work};
  sums_.clear();
  const bool can_tell = gain.found >= kFoundShare && gain.error <= kSharp * gain.value;
  const double least = number == 0 ? kYoung * work : work;
  if (gain.value - kSure * gain.error >= work) {
    verdict_ = Verdict::keep;
  } else if (can_tell && gain.value + kSure * gain.error < least) {
    verdict_ = Verdict::give_up;
  } else if (number == kRounds - 1) {
    verdict_ = gain.found < kFoundShare || gain.value >= work ? Verdict::keep : Verdict::give_up;
  }
}

std::vector<std::byte> TableTrial::saved() const {
  const Finding found = finding_.value_or(Finding{});
  const std::array<double, kSavedNumbers> numbers{finding_ ? 1.0 : 0.0,
                                                  static_cast<double>(found.frame),
                                                  found.gain,
                                                  found.gain_error,
                                                  found.found,
                                                  found.work,
                                                  static_cast<double>(verdict_),
                                                  work_without_,
                                                  static_cast<double>(sums_.size())};
  std::vector<std::byte> bytes;
  append<double>(bytes, numbers);
  for (const HalfSums& sums : sums_) {
    for (const std::vector<glm::dvec3>& half : sums) append<glm::dvec3>(bytes, half);
  }
  return bytes;
}

void TableTrial::restore(std::span<const std::byte> saved) {
  std::array<double, kSavedNumbers> numbers{};
  constexpr std::size_t kHead = sizeof(numbers);
  const bool has_head = saved.size() >= kHead;
  if (has_head) std::memcpy(numbers.data(), saved.data(), kHead);
  const auto sets = static_cast<std::size_t>(std::clamp(numbers[8], 0.0, 2.0));
  const std::size_t rest = has_head ? saved.size() - kHead : 0;
  check(has_head && rest % (std::max<std::size_t>(sets, 1) * 2 * sizeof(glm::dvec3)) == 0 &&
            (sets > 0 || rest == 0) && numbers[6] >= 0 && numbers[6] <= 2,
        "the state has {} bytes of a trial of the table, which cannot be one", saved.size());
  const auto verdict = static_cast<std::uint32_t>(numbers[6]);
  finding_.reset();
  if (numbers[0] != 0)
    finding_ =
        Finding{static_cast<std::uint32_t>(numbers[1]), numbers[2], numbers[3], numbers[4], numbers[5]};
  verdict_ = static_cast<Verdict>(verdict);
  work_without_ = numbers[7];
  sums_.assign(sets, {});
  const std::byte* from = saved.data() + kHead;
  for (HalfSums& sums : sums_) {
    for (std::vector<glm::dvec3>& half : sums) {
      half.resize(rest / (2 * sets) / sizeof(glm::dvec3));
      std::memcpy(half.data(), from, half.size() * sizeof(glm::dvec3));
      from += half.size() * sizeof(glm::dvec3);
    }
  }
}

}  // namespace qtrace
