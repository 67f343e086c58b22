#include "engine/tracer/table_trial.h"

#include "engine/core/check.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace qtrace {
namespace {

// Frames in which the table learns something that can be tried.
constexpr std::uint32_t kBefore = 16;
// Keeps relative variances of dark pixels finite (the metrics' relMSE has the same); radiance squared.
constexpr double kDark = 0.01;
constexpr double kTrimmedShare = 0.001;
// Of the radiance that frames with the table find, what those without it must find for their variance to
// count.
constexpr double kFoundShare = 0.9;
// A pixel's own mean of so few samples would hide what is rare and bright behind itself: means are of square
// blocks.
constexpr std::size_t kBlock = 8;  // pixels along a side

std::vector<glm::dvec3> block_means(const std::array<RadianceImage, 2>& halves) {
  const auto width = static_cast<std::size_t>(halves[0].width);
  const std::size_t across = width / kBlock + 1;
  const auto block_of = [&](std::size_t i) { return i / width / kBlock * across + i % width / kBlock; };
  std::vector<glm::dvec3> sums(block_of(halves[0].pixels() - 1) + 1);
  std::vector<double> counts(sums.size());
  for (std::size_t i = 0; i < halves[0].pixels(); ++i) {
    sums[block_of(i)] += 0.5 * (halves[0].mean[i] + halves[1].mean[i]);
    ++counts[block_of(i)];
  }
  std::vector<glm::dvec3> means;
  for (std::size_t i = 0; i < halves[0].pixels(); ++i)
    means.push_back(sums[block_of(i)] / counts[block_of(i)]);
  return means;
}

void append(std::vector<std::byte>& bytes, const std::vector<glm::dvec3>& values) {
  const auto from = std::as_bytes(std::span(values));
  bytes.insert(bytes.end(), from.begin(), from.end());
}

}  // namespace

TableTrial::TableTrial(const RenderSettings& settings)
    : trial_frames_(settings.sampler == Sampler::rl && !learns_lights(settings)
                        ? static_cast<std::uint32_t>(settings.rl.trial_frames)
                        : 0) {}

bool TableTrial::is_without(std::uint32_t frame) const {
  const bool is_tried = frame > kBefore && frame <= kBefore + 2 * trial_frames_;
  return gave_up() || (is_tried && frame % 2 == 1);
}

bool TableTrial::looks_after(std::uint32_t frame) const {
  return is_wanted() && (frame == kBefore || frame == kBefore + 2 * trial_frames_);
}

TableTrial::Sums TableTrial::sums_of(const RadianceImage& half) {
  const auto n = static_cast<double>(half.samples);
  Sums sums;
  for (std::size_t i = 0; i < half.pixels(); ++i) {
    sums.values.push_back(n * half.mean[i]);
    sums.squares.push_back(n * (n - 1) * half.variance[i] + n * half.mean[i] * half.mean[i]);
  }
  return sums;
}

void TableTrial::look(const std::array<RadianceImage, 2>& halves) {
  if (before_[0].values.empty()) {
    before_ = {sums_of(halves[0]), sums_of(halves[1])};
  } else {
    gain_ = gain_since(halves);
    before_ = {};
  }
}

double TableTrial::gain_since(const std::array<RadianceImage, 2>& halves) const {
  const std::vector<glm::dvec3> means = block_means(halves);
  const auto n = static_cast<double>(trial_frames_);
  std::vector<glm::dvec2> variances(means.size());  // without the table, with it
  glm::dvec2 found{0};
  for (int k = 0; k < 2; ++k) {
    const Sums& before = before_[static_cast<std::size_t>(k)];
    const Sums now = sums_of(halves[static_cast<std::size_t>(k)]);
    for (std::size_t i = 0; i < means.size(); ++i) {
      const glm::dvec3 sum = now.values[i] - before.values[i];
      const glm::dvec3 squares = now.squares[i] - before.squares[i] - sum * sum / n;
      const glm::dvec3 relative = squares / (means[i] * means[i] + kDark);
      variances[i][k] = relative.r + relative.g + relative.b;
      found[k] += (sum.r + sum.g + sum.b) / (means[i].r + means[i].g + means[i].b + std::sqrt(kDark));
    }
  }
  if (found.x < kFoundShare * found.y) return std::numeric_limits<double>::infinity();
  std::ranges::sort(variances, {}, [](const glm::dvec2& v) { return std::max(v.x, v.y); });
  const double trimmed = std::ceil(kTrimmedShare * static_cast<double>(variances.size()));
  variances.resize(variances.size() - static_cast<std::size_t>(trimmed));
  glm::dvec2 sum{0};
  for (const glm::dvec2& v : variances) sum += v;
  return sum.y > 0 ? sum.x / sum.y : 1;
}

std::vector<std::byte> TableTrial::saved() const {
  const double gain = gain_.value_or(-1);
  std::vector<std::byte> bytes(sizeof(gain));
  std::memcpy(bytes.data(), &gain, sizeof(gain));
  for (const Sums& sums : before_) {
    append(bytes, sums.values);
    append(bytes, sums.squares);
  }
  return bytes;
}

void TableTrial::restore(std::span<const std::byte> saved) {
  constexpr std::size_t kParts = 4;  // values and squares of both halves
  double gain = 0;
  check(saved.size() >= sizeof(gain) && (saved.size() - sizeof(gain)) % (kParts * sizeof(glm::dvec3)) == 0,
        "the state has {} bytes of a trial of the table, which cannot be one", saved.size());
  std::memcpy(&gain, saved.data(), sizeof(gain));
  gain_ = gain < 0 ? std::nullopt : std::optional(gain);
  const std::size_t pixels = (saved.size() - sizeof(gain)) / (kParts * sizeof(glm::dvec3));
  const std::byte* from = saved.data() + sizeof(gain);
  for (Sums& sums : before_) {
    for (std::vector<glm::dvec3>* values : {&sums.values, &sums.squares}) {
      values->resize(pixels);
      std::memcpy(values->data(), from, pixels * sizeof(glm::dvec3));
      from += pixels * sizeof(glm::dvec3);
    }
  }
}

}  // namespace qtrace
