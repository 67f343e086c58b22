#include "engine/tracer/film.h"

#include "engine/core/check.h"
#include "engine/gpu/structs.h"

#include <algorithm>
#include <limits>
#include <numeric>
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

// Of the mean of samples of one variance, from their weighed sums.
double variance_of_mean(double sum, double squares, double weight, double weight_squares) {
  const double per_sample = weight_squares / weight;  // 1 where all weights are
  if (weight <= per_sample) return 0;                 // one sample
  return std::max(0.0, (squares - sum * sum / weight) / (weight - per_sample) * per_sample / weight);
}

// Named so in saved states, where there are two.
std::vector<gpu::Buffer> make_sums(std::size_t bytes, int sequences) {
  std::vector<gpu::Buffer> sums;
  for (int i = 0; i < sequences; ++i) {
    const std::string name = sequences > 2 ? fmt::format("pixel sums of sequence {}", i)
                                           : fmt::format("pixel sums of {} frames", i == 0 ? "odd" : "even");
    sums.emplace_back(name, bytes, gpu::also_fetched(gpu::Texels::uint4));
  }
  return sums;
}

gpu::PixelSum add(const gpu::PixelSum& a, const gpu::PixelSum& b) {
  return {a.r + b.r,
          a.g + b.g,
          a.b + b.b,
          a.r_squared + b.r_squared,
          a.g_squared + b.g_squared,
          a.b_squared + b.b_squared};
}

// The sums of sequences that are independent of one another, of one pixel.
struct SequenceSums {
  glm::dvec3 sum{0};       // over sequences, of their sums
  glm::dvec3 squares{0};   // of the squares of these
  glm::dvec3 products{0};  // of these times their weights
  double weight = 0;
  double weight_squares = 0;
  double sequences = 0;

  void add(const glm::dvec3& of_sequence, double weight_of_sequence) {
    sum += of_sequence;
    squares += of_sequence * of_sequence;
    products += weight_of_sequence * of_sequence;
    weight += weight_of_sequence;
    weight_squares += weight_of_sequence * weight_of_sequence;
    ++sequences;
  }
  glm::dvec3 mean() const { return weight > 0 ? sum / weight : glm::dvec3(0); }
  // Of the mean: the spread of the sums about what their weights let expect. Where all weigh the same, the
  // divisor has the n - 1 of n sequences.
  glm::dvec3 variance() const {
    if (sequences < 2) return glm::dvec3(0);
    const glm::dvec3 m = mean();
    const glm::dvec3 spread = squares - 2.0 * m * products + m * m * weight_squares;
    return glm::max(spread, 0.0) / (weight * weight - weight_squares);
  }
};

}  // namespace

Film::Film(int width, int height, int replicates, int light_paths, gpu::ProgramCache& programs)
    : width_(width),
      height_(height),
      replicates_(replicates),
      samples_("pixel samples",
               static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * sizeof(gpu::PixelSample),
               gpu::also_fetched(gpu::Texels::uint4)),
      sums_(make_sums(
          static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * sizeof(gpu::PixelSum),
          std::max(replicates, 2))),
      weights_(sums_.size()),
      outliers_(
          "pixel outliers",
          static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * sizeof(gpu::PixelOutliers),
          gpu::also_fetched(gpu::Texels::uint4)),
      counters_("statistics", sizeof(gpu::Counters)),  // named so in saved states
      accumulate_(programs.get("passes/accumulate.comp", {})) {
  if (light_paths == 0) return;
  accumulate_with_light_paths_ = programs.get("passes/accumulate.comp", {{"HAS_LIGHT_PATHS", "1"}});
  splats_.emplace("splats", samples_.bytes() / sizeof(gpu::PixelSample) * sizeof(gpu::PixelSplat));
  light_paths_.emplace("light paths", static_cast<std::size_t>(light_paths) * sizeof(gpu::uvec4));
}

void Film::bind() const {
  samples_.bind_storage(gpu::BINDING_SAMPLES);
  samples_.bind_fetched(gpu::UNIT_SAMPLES);
  outliers_.bind_storage(gpu::BINDING_OUTLIERS);
  outliers_.bind_fetched(gpu::UNIT_OUTLIERS);
  counters_.bind_storage(gpu::BINDING_COUNTERS);
  if (!splats_) return;
  splats_->bind_storage(gpu::BINDING_SPLATS);
  light_paths_->bind_storage(gpu::BINDING_LIGHT_PATHS);
}

void Film::start_frame() {
  constexpr std::size_t kCounterBytes = 2 * sizeof(gpu::uint);
  counters_.clear(offsetof(gpu::Counters, words), gpu::COUNTER_PER_FRAME * kCounterBytes);
}

void Film::accumulate(std::uint32_t frame, float weight, bool has_light_paths) {
  count(frame, weight);
  gpu::Program& program = has_light_paths ? *accumulate_with_light_paths_ : *accumulate_;
  const gpu::Buffer& sums = sums_[place(frame)];
  sums.bind_storage(gpu::BINDING_SUMS);
  sums.bind_fetched(gpu::UNIT_SUMS);
  program.set_frame(frame);
  program.set_weight(weight);
  const auto pixels = static_cast<std::uint32_t>(samples_.bytes() / sizeof(gpu::PixelSample));
  program.dispatch((pixels + gpu::ACCUMULATE_GROUP_PIXELS - 1) / gpu::ACCUMULATE_GROUP_PIXELS);
}

void Film::count(std::uint32_t frame, float weight) {
  Weights& w = weights_[place(frame)];
  ++w.frames;
  w.sum += weight;
  w.squares += double{weight} * weight;
}

void Film::count_all(std::uint32_t last, const std::function<float(std::uint32_t)>& weight) {
  std::ranges::fill(weights_, Weights{});
  for (std::uint32_t frame = 1; frame <= last; ++frame) count(frame, weight(frame));
}

void Film::note_non_finite(std::span<const NonFiniteSample> samples) {
  if (samples.empty()) return;
  gpu::Counters block = read_block(counters_);
  gpu::uint& noted = block.words[std::size_t{2} * gpu::COUNTER_ALL_NON_FINITE];  // the low word
  for (const NonFiniteSample& sample : samples) {
    if (noted < gpu::MAX_LOCATIONS / 2) block.locations[noted++] = {sample.x, sample.y, sample.frame, 0};
  }
  counters_.write(0, &block, sizeof(block));
}

void Film::reset() {
  samples_.clear();
  if (splats_) splats_->clear();
  for (gpu::Buffer& sums : sums_) sums.clear();
  std::ranges::fill(weights_, Weights{});
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

double Film::kept_events(std::uint32_t paths) const {
  if (!light_paths_) return 0;
  double events = 0;
  std::uint32_t path = 0;
  for (const gpu::uvec4& counts : light_paths_->read_all<gpu::uvec4>()) {
    if (path++ < paths) events += counts.y >> 16;  // beside the splats (trace_light.comp)
  }
  return events;
}

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
  s.light_rays = counter(block, gpu::COUNTER_LIGHT_RAYS);
  s.splats = counter(block, gpu::COUNTER_SPLATS);
  s.connections = counter(block, gpu::COUNTER_CONNECTIONS);
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
  const Weights weights = all_weights();
  if (weights.sum > 0) {
    result.firefly_sum *= weights.frames / weights.sum;
    result.clamped_away *= weights.frames / weights.sum;
  }
  std::ranges::sort(result.brightest, {}, [](const Firefly& f) { return std::tuple(-f.radiance, f.y, f.x); });
  return result;
}

Film::Weights Film::joined(const Weights& a, const Weights& b) {
  return {a.frames + b.frames, a.sum + b.sum, a.squares + b.squares};
}

Film::Weights Film::all_weights() const {
  return std::accumulate(weights_.begin(), weights_.end(), Weights{}, joined);
}

RadianceImage Film::image_of(const std::vector<gpu::PixelSum>& sums, const Weights& w) const {
  RadianceImage image{width_, height_, w.frames, {}, {}};
  for (const gpu::PixelSum& s : sums) {
    image.mean.push_back(w.frames > 0 ? glm::dvec3(s.r, s.g, s.b) / w.sum : glm::dvec3(0));
    image.variance.emplace_back(variance_of_mean(s.r, s.r_squared, w.sum, w.squares),
                                variance_of_mean(s.g, s.g_squared, w.sum, w.squares),
                                variance_of_mean(s.b, s.b_squared, w.sum, w.squares));
  }
  return image;
}

RadianceImage Film::radiance() const {
  check_loops();
  return replicates_ > 1 ? over_replicates() : over_samples();
}

RadianceImage Film::over_samples() const {
  auto sums = sums_[0].read_all<gpu::PixelSum>();
  std::ranges::transform(sums, sums_[1].read_all<gpu::PixelSum>(), sums.begin(), add);
  return image_of(sums, all_weights());
}

RadianceImage Film::over_replicates() const {
  std::vector<SequenceSums> pixels(samples_.bytes() / sizeof(gpu::PixelSample));
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    if (weights_[i].frames == 0) continue;
    auto pixel = pixels.begin();
    for (const gpu::PixelSum& s : sums_[i].read_all<gpu::PixelSum>())
      (pixel++)->add({s.r, s.g, s.b}, weights_[i].sum);
  }
  RadianceImage image{width_, height_, all_weights().frames, {}, {}};
  for (const SequenceSums& sums : pixels) {
    image.mean.push_back(sums.mean());
    image.variance.push_back(sums.variance());
  }
  return image;
}

std::pair<std::vector<gpu::PixelSum>, Film::Weights> Film::half(std::size_t half) const {
  auto sums = sums_[half].read_all<gpu::PixelSum>();
  Weights weights = weights_[half];
  for (std::size_t i = half + 2; i < sums_.size(); i += 2) {
    std::ranges::transform(sums, sums_[i].read_all<gpu::PixelSum>(), sums.begin(), add);
    weights = joined(weights, weights_[i]);
  }
  return {std::move(sums), weights};
}

std::array<RadianceImage, 2> Film::halves() const {
  check_loops();
  const auto image = [this](const auto& half) { return image_of(half.first, half.second); };
  return {image(half(0)), image(half(1))};
}

std::array<std::vector<glm::vec3>, 2> Film::half_sums() const {
  check_loops();
  std::array<std::vector<glm::vec3>, 2> halves;
  for (std::size_t i = 0; i < 2; ++i) {
    for (const gpu::PixelSum& s : half(i).first) halves[i].emplace_back(s.r, s.g, s.b);
  }
  return halves;
}

std::vector<gpu::Buffer*> Film::gathered() {
  std::vector<gpu::Buffer*> all;
  for (gpu::Buffer& sums : sums_) all.push_back(&sums);
  all.insert(all.end(), {&outliers_, &counters_});
  return all;
}

}  // namespace qtrace
