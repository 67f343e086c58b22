#include "engine/tracer/trial.h"

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
// Of a connection of the camera's path to a light path's event, beside its ray: 2.1 and 3.1 on two scenes.
constexpr double kWorkPerConnection = 2.5;
// Standard errors that a gain must be away from its limit, and that it must be half-way through the pilot.
constexpr double kSure = 2;
constexpr double kSureEarly = 3;
// The relative standard error above which the table is not given up yet: where a few blocks have most of the
// error, it is itself uncertain, and a table that is lost costs more than one that is kept.
constexpr double kSharp = 0.1;
// The same in the pilot where there are no light samples and less than half of the paths find light: the
// table that these few have taught becomes much better yet. Under an open sky, every path finds light.
constexpr double kSharpWhereLightIsRare = 0.05;
constexpr std::uint64_t kPathsForEachThatFindsLight = 2;
// The relative standard error above which a gain says nothing.
constexpr double kBlunt = 0.25;
// What a gain in the pilot may lack, as the table has seen few paths by then.
constexpr double kYoung = 0.9;
// By which power of N a squared error is believed to fall: N^-s, s = 1 for independent samples.
constexpr double kLeastSlope = 1;
constexpr double kMostSlope = 1.5;

// The least that a frame without the table weighs in a round.
constexpr double kLeastWeight = 0.1;

constexpr std::size_t kSavedNumbers = 10;

// Whether a gain is good for giving a table up, given the largest relative standard error for that.
bool tells(const Trial::Finding& finding, double largest_error) {
  return std::abs(finding.found - 1) <= kFoundApart && finding.gain_error <= largest_error * finding.gain;
}

double work_of(const FrameCounters& counters) {
  return static_cast<double>(counters.rays) + kWorkPerLookup * static_cast<double>(counters.cell_lookups) +
         kWorkPerConnection * static_cast<double>(counters.connections);
}

double work_of(const FrameCounters& with_table, double without) {
  return without > 0 ? work_of(with_table) / without : 1;
}

// The gain that pays for the table's work. With independent samples, as much. With Sobol' points the error
// falls as N^-s without the table, s > 1: fewer frames for the same work lose N^-s, not N^-1; and where what
// learns has the sequence start anew after 1, 2, 4, ... frames, the sum of these nets has the squared error
// Σ L^(2-s) / N^2 = N^-s / (2^(2-s) - 1).
// `halfway`, `all`: frames without the table.
double needed_gain(double work, bool learns, TriedFrames halfway, TriedFrames all, int width) {
  const double ratio = gain_of({std::move(halfway), std::move(all)}, width).value;
  const double slope = std::clamp(std::log2(ratio), kLeastSlope, kMostSlope);
  return std::pow(work, slope) / (learns ? std::exp2(2 - slope) - 1 : 1);
}

}  // namespace

void Trial::look_at_pilot(PilotLook seen) {
  const std::uint32_t tried = seen.frame - pilot_lessons();
  if (tried == 2) {
    HalfSums nothing;
    for (auto& half : nothing) half.assign(seen.sums[0].size(), glm::vec3(0));
    tried_.start(random_, std::move(nothing));
  }
  tried_.add(std::move(seen.sums), {1, 1});
  // Half-way, each sequence must have two frames of either kind for its slope.
  const bool is_halfway = tried == 2 * plan_.unit && plan_.unit % 4 == 0;
  if (is_halfway || seen.frame == pilot_frames()) {
    finding_ = found(0, work_of(seen.counters[1], work_of(seen.counters[0])), seen.width);
    const FrameCounters& without = seen.counters[0];
    const bool is_light_rare =
        without.paths - without.zero_paths < without.paths / kPathsForEachThatFindsLight;
    judge_pilot(is_halfway, !plan_.has_light_samples && is_light_rare ? kSharpWhereLightIsRare : kSharp);
    if (!plan_.has_rounds && !is_halfway && !is_decided()) conclude(true);
  }
  if (tried == plan_.unit || tried == 2 * plan_.unit) tried_.mark();
  if (is_decided() || seen.frame == pilot_frames()) tried_ = {};
}

Trial::Finding Trial::found(std::uint32_t frame, double work, int width) const {
  const Gain gain = gain_of({tried_.frames(0), tried_.frames(1)}, width);
  const double needed =
      random_ == RandomNumbers::independent
          ? work
          : needed_gain(work, plan_.lessons > 0, tried_.halfway(0), tried_.frames(0), width);
  return {frame, gain.value, gain.error, gain.found, work, needed};
}

void Trial::judge_pilot(bool is_halfway, double sharp) {
  pilot_gain_ = finding_->gain;
  const double error = (is_halfway ? kSureEarly : kSure) * finding_->gain_error;
  // The first two points of a sequence do not show yet how steep the curve will be.
  const bool knows_needed = !is_halfway || random_ == RandomNumbers::independent;
  if (knows_needed && finding_->gain - error >= finding_->needed) {
    verdict_ = Verdict::keep;
  } else if (tells(*finding_, sharp) && finding_->gain + error < kYoung * finding_->needed) {
    verdict_ = Verdict::give_up;
  }
}

std::array<Trial::Round, 2> Trial::rounds() const {
  const auto round = [this](std::uint32_t start) {
    return Round{plan_.unit * start, plan_.unit * (start + kRoundLength)};
  };
  return {round(kRoundStarts[0]), round(kRoundStarts[1])};
}

bool Trial::takes_place(const Round& round) const {
  return is_wanted() && plan_.has_rounds && (!is_decided() || round.end <= finding_->frame);
}

bool Trial::is_tried(std::uint32_t frame) const {
  return std::ranges::any_of(
      rounds(), [&](const Round& r) { return takes_place(r) && frame > r.begin && frame <= r.end; });
}

bool Trial::is_without(std::uint32_t frame) const {
  if (gave_up() && frame > finding_->frame) return true;
  return is_tried(frame) && frame % 2 == 1;
}

std::uint32_t Trial::last_boundary(std::uint32_t frame) const {
  std::uint32_t last = 0;
  for (const Round& r : rounds()) {
    if (!takes_place(r)) continue;
    for (const std::uint32_t boundary : {r.begin, r.end}) {
      if (boundary <= frame) last = std::max(last, boundary);
    }
  }
  return last;
}

double Trial::weight(std::uint32_t frame) const {
  const Round first = rounds().front();
  const bool is_of_it = frame > first.begin && frame <= first.end && is_tried(frame) && is_without(frame);
  return is_of_it && pilot_gain_ > 1 ? std::max(1 / pilot_gain_, kLeastWeight) : 1;
}

bool Trial::looks_after(std::uint32_t frame) const {
  if (!is_wanted() || !plan_.has_rounds || is_decided()) return false;
  return std::ranges::any_of(rounds(), [&](const Round& r) {
    return frame >= r.begin && frame <= r.end && (frame % 2 == 0 || frame == r.end - 1);
  });
}

void Trial::look(Look seen) {
  for (const Round& r : rounds()) {
    if (seen.frame < r.begin || seen.frame > r.end) continue;
    if (seen.frame == r.begin) {
      tried_.start(random_, std::move(seen.sums));
    } else if (seen.frame == r.end - 1) {
      work_without_ = work_of(seen.counters);
    } else {
      tried_.add(std::move(seen.sums), seen.weights);
    }
    if (seen.frame - r.begin == (r.end - r.begin) / 2) tried_.mark();
    if (seen.frame != r.end) return;
    check(2 * tried_.pairs() == r.end - r.begin, "the trial of the table has not seen the frames before {}",
          seen.frame);
    finding_ = found(seen.frame, work_of(seen.counters, work_without_), seen.width);
    tried_ = {};
    conclude(r.end == rounds().back().end);
  }
}

void Trial::conclude(bool is_last) {
  const double most = finding_->gain + kSure * finding_->gain_error;
  if (finding_->gain >= finding_->needed) {
    verdict_ = Verdict::keep;
  } else if (tells(*finding_, kSharp) && (is_last || most < finding_->needed)) {
    verdict_ = Verdict::give_up;
  } else if (is_last) {
    verdict_ = tells(*finding_, kBlunt) && most < finding_->needed ? Verdict::give_up : Verdict::keep;
  }
}

std::vector<std::byte> Trial::saved() const {
  const Finding found = finding_.value_or(Finding{});
  const std::array<double, kSavedNumbers> numbers{finding_ ? 1.0 : 0.0, static_cast<double>(found.frame),
                                                  found.gain,           found.gain_error,
                                                  found.found,          found.work,
                                                  found.needed,         static_cast<double>(verdict_),
                                                  work_without_,        pilot_gain_};
  const auto head = std::as_bytes(std::span(numbers));
  std::vector<std::byte> bytes(head.begin(), head.end());
  const std::vector<std::byte> tried = tried_.saved();
  bytes.insert(bytes.end(), tried.begin(), tried.end());
  return bytes;
}

void Trial::restore(std::span<const std::byte> saved) {
  std::array<double, kSavedNumbers> numbers{};
  constexpr std::size_t kHead = sizeof(numbers);
  const bool has_head = saved.size() >= kHead;
  if (has_head) std::memcpy(numbers.data(), saved.data(), kHead);
  check(has_head && numbers[7] >= 0 && numbers[7] <= 2,
        "the state has {} bytes of a trial of the table, which cannot be one", saved.size());
  tried_.restore(random_, saved.subspan(kHead));
  finding_.reset();
  if (numbers[0] != 0)
    finding_ = Finding{
        static_cast<std::uint32_t>(numbers[1]), numbers[2], numbers[3], numbers[4], numbers[5], numbers[6]};
  verdict_ = static_cast<Verdict>(static_cast<std::uint32_t>(numbers[7]));
  work_without_ = numbers[8];
  pilot_gain_ = numbers[9];
}

Trial trial_of_table(const RenderSettings& settings) {
  const bool is_wanted = settings.sampler == Sampler::rl && !learns_lights(settings);
  return {{.unit = is_wanted ? static_cast<std::uint32_t>(settings.rl.trial_frames) : 0,
           .lessons = 2,
           .has_rounds = true,
           .has_light_samples = settings.nee != Nee::none},
          settings.random};
}

Trial trial_of_light_paths(const RenderSettings& settings) {
  const bool is_wanted = settings.light_paths != LightPaths::none;
  return {{.unit = is_wanted ? static_cast<std::uint32_t>(settings.light_path_trial) : 0}, settings.random};
}

}  // namespace qtrace
