#include "engine/tracer/film.h"

#include "engine/core/check.h"
#include "engine/gpu/structs.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace qtrace {
namespace {

std::uint64_t counter(const gpu::Counters& block, gpu::uint index) {
  return (std::uint64_t{block.words[2 * index + 1]} << 32) | block.words[2 * index];
}

gpu::Counters read_block(const gpu::Buffer& buffer) {
  gpu::Counters block;
  buffer.read(0, &block, sizeof(block));
  return block;
}

void check_loops_of(const gpu::Counters& block) {
  if (counter(block, gpu::COUNTER_LOOPS_CUT) == 0) return;
  fail(
      "the driver cut a shader loop short at pixel ({}, {}), so the image would be wrong: this device allows "
      "too few loop iterations for these settings; search sites by lists, lower max_bounces, or split large "
      "overlapping meshes",
      block.cut_pixel.x, block.cut_pixel.y);
}

// Variance of the mean of n samples from their sum and sum of squares.
double variance_of_mean(double sum, double squares, double n) {
  if (n < 2) return 0;
  return std::max(0.0, (squares - sum * sum / n) / (n - 1) / n);
}

gpu::PixelSum add(const gpu::PixelSum& a, const gpu::PixelSum& b) {
  return {a.r + b.r,
          a.g + b.g,
          a.b + b.b,
          a.r_squared + b.r_squared,
          a.g_squared + b.g_squared,
          a.b_squared + b.b_squared};
}

RadianceImage image_of(const std::vector<gpu::PixelSum>& sums, int width, int height, std::uint32_t frames) {
  RadianceImage image{width, height, frames, {}, {}};
  const double n = frames;
  for (const gpu::PixelSum& s : sums) {
    image.mean.push_back(frames > 0 ? glm::dvec3(s.r, s.g, s.b) / n : glm::dvec3(0));
    image.variance.emplace_back(variance_of_mean(s.r, s.r_squared, n), variance_of_mean(s.g, s.g_squared, n),
                                variance_of_mean(s.b, s.b_squared, n));
  }
  return image;
}

}  // namespace

Film::Film(int width, int height, gpu::ProgramCache& programs)
    : width_(width),
      height_(height),
      samples_("pixel samples",
               static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * sizeof(gpu::PixelSample),
               gpu::also_fetched(gpu::Texels::uint4)),
      odd_sums_("pixel sums of odd frames",
                static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * sizeof(gpu::PixelSum),
                gpu::also_fetched(gpu::Texels::uint4)),
      even_sums_("pixel sums of even frames", odd_sums_.bytes(), gpu::also_fetched(gpu::Texels::uint4)),
      outliers_(
          "pixel outliers",
          static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * sizeof(gpu::PixelOutliers),
          gpu::also_fetched(gpu::Texels::uint4)),
      counters_("statistics", sizeof(gpu::Counters)),  // named so in saved states
      accumulate_(programs.get("passes/accumulate.comp", {})) {}

void Film::bind() const {
  samples_.bind_storage(gpu::BINDING_SAMPLES);
  samples_.bind_fetched(gpu::UNIT_SAMPLES);
  outliers_.bind_storage(gpu::BINDING_OUTLIERS);
  outliers_.bind_fetched(gpu::UNIT_OUTLIERS);
  counters_.bind_storage(gpu::BINDING_COUNTERS);
}

void Film::start_frame() {
  constexpr std::size_t kCounterBytes = 2 * sizeof(gpu::uint);
  counters_.clear(offsetof(gpu::Counters, words), gpu::COUNTER_PER_FRAME * kCounterBytes);
}

void Film::accumulate(std::uint32_t frame) {
  const gpu::Buffer& sums = frame % 2 == 1 ? odd_sums_ : even_sums_;
  sums.bind_storage(gpu::BINDING_SUMS);
  sums.bind_fetched(gpu::UNIT_SUMS);
  accumulate_->set_frame(frame);
  const auto pixels = static_cast<std::uint32_t>(samples_.bytes() / sizeof(gpu::PixelSample));
  accumulate_->dispatch((pixels + gpu::ACCUMULATE_GROUP_PIXELS - 1) / gpu::ACCUMULATE_GROUP_PIXELS);
}

void Film::reset() {
  samples_.clear();
  odd_sums_.clear();
  even_sums_.clear();
  counters_.clear();
  const auto pixels = outliers_.bytes() / sizeof(gpu::PixelOutliers);
  set_firefly_thresholds(std::vector<float>(pixels, std::numeric_limits<float>::infinity()));
}

void Film::set_firefly_thresholds(std::span<const float> thresholds) {
  std::vector<gpu::PixelOutliers> outliers;
  for (const float threshold : thresholds) outliers.push_back({0, 0, threshold, 0, 0, 0});
  check(outliers.size() * sizeof(gpu::PixelOutliers) == outliers_.bytes(),
        "{} firefly thresholds were given for {}x{} pixels", thresholds.size(), width_, height_);
  outliers_.write(0, outliers.data(), outliers_.bytes());
}

void Film::check_loops() const { check_loops_of(read_block(counters_)); }

FrameCounters Film::counters() const {
  const gpu::Counters block = read_block(counters_);
  check_loops_of(block);
  FrameCounters s;
  s.paths = static_cast<std::uint64_t>(width_) * static_cast<std::uint64_t>(height_);
  s.rays = counter(block, gpu::COUNTER_RAYS);
  s.path_segments = counter(block, gpu::COUNTER_SEGMENTS);
  s.zero_paths = counter(block, gpu::COUNTER_ZERO_PATHS);
  s.cell_lookups = counter(block, gpu::COUNTER_LOOKUPS);
  s.cell_fallbacks = counter(block, gpu::COUNTER_FALLBACKS);
  s.non_finite = counter(block, gpu::COUNTER_NON_FINITE);
  s.table_updates = counter(block, gpu::COUNTER_UPDATES);
  s.saturated_updates = counter(block, gpu::COUNTER_SATURATED);
  s.fireflies = counter(block, gpu::COUNTER_FIREFLIES);
  s.clamped_samples = counter(block, gpu::COUNTER_CLAMPED);
  return s;
}

std::vector<NonFiniteSample> Film::non_finite_samples() const {
  const gpu::Counters block = read_block(counters_);
  const auto stored =
      std::min<std::uint64_t>(counter(block, gpu::COUNTER_ALL_NON_FINITE), gpu::MAX_LOCATIONS);
  std::vector<NonFiniteSample> samples;
  for (std::uint64_t i = 0; i < stored; ++i) {
    samples.push_back({block.locations[i].x, block.locations[i].y, block.locations[i].z});
  }
  std::ranges::sort(samples, {}, [](const NonFiniteSample& s) { return std::tuple(s.frame, s.y, s.x); });
  return samples;
}

Outliers Film::outliers() const {
  Outliers result;
  std::uint32_t pixel = 0;
  const auto width = static_cast<std::uint32_t>(width_);
  for (const gpu::PixelOutliers& p : outliers_.read_all<gpu::PixelOutliers>()) {
    result.firefly_sum += p.firefly_sum;
    result.clamped_away += p.clamped_away;
    if (p.fireflies > 0) {
      result.brightest.push_back({pixel % width, pixel / width, p.brightest_frame, p.brightest});
    }
    ++pixel;
  }
  std::ranges::sort(result.brightest, {}, [](const Firefly& f) { return std::tuple(-f.radiance, f.y, f.x); });
  return result;
}

RadianceImage Film::radiance(std::uint32_t frames) const {
  check_loops();
  auto sums = odd_sums_.read_all<gpu::PixelSum>();
  std::ranges::transform(sums, even_sums_.read_all<gpu::PixelSum>(), sums.begin(), add);
  return image_of(sums, width_, height_, frames);
}

std::array<RadianceImage, 2> Film::halves(std::uint32_t frames) const {
  check_loops();
  return {image_of(odd_sums_.read_all<gpu::PixelSum>(), width_, height_, (frames + 1) / 2),
          image_of(even_sums_.read_all<gpu::PixelSum>(), width_, height_, frames / 2)};
}

std::vector<gpu::Buffer*> Film::gathered() { return {&odd_sums_, &even_sums_, &outliers_, &counters_}; }

}  // namespace qtrace
