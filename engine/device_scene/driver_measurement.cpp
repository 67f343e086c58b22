#include "engine/device_scene/driver_measurement.h"

#include "engine/accel/build_bvh.h"
#include "engine/device_scene/scene_buffers.h"
#include "engine/gpu/buffer.h"
#include "engine/gpu/driver_probe.h"
#include "engine/gpu/program.h"
#include "engine/gpu/structs.h"
#include "engine/scene/scene.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <optional>
#include <random>
#include <utility>

namespace qtrace::gpu {
namespace {

constexpr std::uint32_t kGroup = 64;  // invocations of a work group of ray_probe.comp
constexpr int kRounds = 11;
// A way must be faster by this factor than the usual one to be taken in its place: less is noise, and no
// gain.
constexpr double kWorthwhile = 0.85;

// As many triangles as the shipped scenes have, in the unit cube.
Scene room_of_triangles() {
  constexpr int kTriangles = 6000;
  constexpr float kSize = 0.08F;
  std::mt19937 random(5);
  const auto uniform = [&random] { return static_cast<float>(random() >> 8U) * 0x1p-24F; };
  const auto point = [&uniform] {
    const float x = uniform(), y = uniform(), z = uniform();
    return glm::vec3(x, y, z);
  };
  Scene scene;
  scene.materials.emplace_back();
  for (int i = 0; i < kTriangles; ++i) {
    const glm::vec3 a = point();
    const glm::vec3 b = a + kSize * (point() - 0.5F);
    const glm::vec3 c = a + kSize * (point() - 0.5F);
    const glm::vec3 area = glm::cross(b - a, c - a);
    if (glm::length(area) < 1e-6F) continue;
    const glm::vec3 n = glm::normalize(area);
    scene.triangles.push_back({{a, b, c}, {n, n, n}, {}, 0, 0});
  }
  scene.objects = {{"triangles", 0, static_cast<std::uint32_t>(scene.triangles.size()), false}};
  return scene;
}

// A way that is measured.
struct Entry {
  DriverChoices choices;
  Program program;
  double milliseconds = 0;
};

class Bench {
 public:
  explicit Bench(Context& context)
      : context_(context),
        before_(context.device().choices),
        room_(room_of_triangles()),
        buffers_(room_, build_bvh(room_, BvhKind::sah)),
        answers_("answers", std::size_t{kMostGroups} * kGroup * sizeof(std::uint32_t)) {
    buffers_.bind();
    answers_.bind_storage(BINDING_OUTPUT);
  }
  ~Bench() { context_.use(before_); }
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  // Nothing where its answers differ from those of the first one.
  std::optional<Entry> compile(const DriverChoices& choices) {
    context_.use(choices);
    Entry entry{choices, Program("passes/ray_probe.comp", {})};
    entry.program.dispatch(kLeastGroups);
    std::vector<std::uint32_t> answers(std::size_t{kLeastGroups} * kGroup);
    answers_.read(0, answers.data(), answers.size() * sizeof(std::uint32_t));
    if (truth_.empty()) {
      truth_ = answers;
      find_size(entry.program);
    }
    if (answers != truth_) return std::nullopt;
    return entry;
  }

  // Each takes its turn in every round.
  void measure(std::vector<Entry>& entries) {
    std::vector<std::vector<double>> times(entries.size());
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t i = 0; i < entries.size(); ++i) times[i].push_back(time_of(entries[i].program));
    }
    for (std::size_t i = 0; i < entries.size(); ++i) {
      std::ranges::sort(times[i]);
      entries[i].milliseconds = times[i][kRounds / 2];
    }
  }

 private:
  // A busy machine disturbs processor time less than the clock; a GPU's work is in the latter alone.
  double now_ms() const {
    constexpr double kMillisecondsPerSecond = 1000;
    if (context_.device().software)
      return kMillisecondsPerSecond * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double, std::milli>(now).count();
  }

  double time_of(const Program& program) const {
    context_.finish();
    const double start = now_ms();
    program.dispatch(groups_);
    context_.finish();
    return now_ms() - start;
  }

  // So many work groups that a dispatch takes milliseconds.
  void find_size(const Program& program) {
    constexpr double kLeast = 4;
    while (groups_ < kMostGroups && time_of(program) < kLeast) groups_ *= 2;
  }

  static constexpr std::uint32_t kLeastGroups = 16;
  static constexpr std::uint32_t kMostGroups = 16384;

  Context& context_;
  DriverChoices before_;
  Scene room_;
  SceneBuffers buffers_;
  Buffer answers_;
  std::vector<std::uint32_t> truth_;
  std::uint32_t groups_ = kLeastGroups;
};

// The first, unless another one is worth it.
Entry& best_of(std::vector<Entry>& entries) {
  Entry& fastest = *std::ranges::min_element(entries, {}, &Entry::milliseconds);
  return fastest.milliseconds < kWorthwhile * entries.front().milliseconds ? fastest : entries.front();
}

}  // namespace

DriverMeasurement measure_driver(Context& context) {
  Bench bench(context);
  DriverChoices usual = usual_choices();
  if (!splits_by_place(usual.work_threads)) usual.work_threads = 1;
  std::vector<DriverChoices> ways{usual};
  for (const Fetch fetch : {Fetch::texture, Fetch::image, Fetch::storage}) {
    if (fetch != usual.fetch && offers(fetch)) ways.push_back({fetch, usual.stack, usual.work_threads});
  }
  std::vector<Entry> entries;
  for (const DriverChoices& way : ways) {
    if (auto entry = bench.compile(way)) entries.push_back(std::move(*entry));
  }
  bench.measure(entries);
  DriverMeasurement result;
  for (const Entry& entry : entries) result.ways.push_back({entry.choices, entry.milliseconds});
  std::vector<Entry> finalists;
  finalists.push_back(std::move(best_of(entries)));
  DriverChoices other = finalists.front().choices;
  other.stack = other.stack == StackPlace::memory ? StackPlace::registers : StackPlace::memory;
  if (auto entry = bench.compile(other)) {
    finalists.push_back(std::move(*entry));
    bench.measure(finalists);
    result.ways.push_back({other, finalists.back().milliseconds});
  }
  result.best = best_of(finalists).choices;
  return result;
}

}  // namespace qtrace::gpu
