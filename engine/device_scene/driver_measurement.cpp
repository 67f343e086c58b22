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
#include <random>

namespace qtrace::gpu {
namespace {

constexpr std::uint32_t kGroup = 64;  // invocations of a work group of ray_probe.comp
constexpr int kRounds = 7;
// A way must be faster by this factor than the usual one to be taken in its place: less is noise, and no
// gain.
constexpr double kWorthwhile = 0.93;

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

class Bench {
 public:
  explicit Bench(Context& context)
      : context_(context),
        before_(context.device().choices),
        room_(room_of_triangles()),
        buffers_(room_, build_bvh(room_, BvhKind::sah)) {}
  ~Bench() { context_.use(before_); }
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  // Medians of the given ways, of which each takes its turn in every round; the first is the usual one. Ways
  // whose answers differ from its are left out.
  std::vector<MeasuredWay> measure(const std::vector<DriverChoices>& ways) {
    std::vector<Entry> entries;
    for (const DriverChoices& way : ways) {
      context_.use(way);
      entries.push_back({way, Program("passes/ray_probe.comp", {}), {}});
      const std::vector<std::uint32_t> answers = answers_of(entries.back().program);
      if (truth_.empty()) truth_ = answers;
      if (answers != truth_) entries.pop_back();
    }
    find_size(entries.front().program);
    for (int round = 0; round < kRounds; ++round) {
      for (Entry& entry : entries) entry.milliseconds.push_back(time_of(entry.program));
    }
    std::vector<MeasuredWay> measured;
    for (Entry& entry : entries) {
      std::ranges::sort(entry.milliseconds);
      measured.push_back({entry.choices, entry.milliseconds[kRounds / 2]});
    }
    return measured;
  }

 private:
  struct Entry {
    DriverChoices choices;
    Program program;
    std::vector<double> milliseconds;
  };

  std::vector<std::uint32_t> answers_of(const Program& program) {
    constexpr std::uint32_t kChecked = 1024;
    buffers_.bind();
    const Buffer answers("answers", kChecked * sizeof(std::uint32_t));
    answers.bind_storage(BINDING_OUTPUT);
    program.dispatch(kChecked / kGroup);
    return answers.read_all<std::uint32_t>();
  }

  double time_of(const Program& program) {
    const Buffer answers("answers", std::size_t{groups_} * kGroup * sizeof(std::uint32_t));
    answers.bind_storage(BINDING_OUTPUT);
    context_.finish();
    const auto start = std::chrono::steady_clock::now();
    program.dispatch(groups_);
    context_.finish();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }

  // So many work groups that a dispatch takes milliseconds.
  void find_size(const Program& program) {
    constexpr double kLeast = 3;  // ms
    constexpr std::uint32_t kMost = 16384;
    while (groups_ < kMost && time_of(program) < kLeast) groups_ *= 2;
  }

  Context& context_;
  DriverChoices before_;
  Scene room_;
  SceneBuffers buffers_;
  std::vector<std::uint32_t> truth_;
  std::uint32_t groups_ = 64;
};

DriverChoices best_of(const std::vector<MeasuredWay>& ways) {
  const auto fastest = std::ranges::min_element(ways, {}, &MeasuredWay::milliseconds);
  const bool is_worthwhile = fastest->milliseconds < kWorthwhile * ways.front().milliseconds;
  return is_worthwhile ? fastest->choices : ways.front().choices;
}

}  // namespace

DriverMeasurement measure_driver(Context& context) {
  Bench bench(context);
  DriverChoices usual = usual_choices();
  if (!splits_by_place(usual.work_threads)) usual.work_threads = 1;
  DriverMeasurement result;
  const auto add = [&](const std::vector<DriverChoices>& ways) {
    const std::vector<MeasuredWay> measured = bench.measure(ways);
    result.best = best_of(measured);
    result.ways.insert(result.ways.end(), measured.begin(), measured.end());
  };
  std::vector<DriverChoices> ways{usual};
  for (const Fetch fetch : {Fetch::texture, Fetch::image, Fetch::storage}) {
    if (fetch != usual.fetch && offers(fetch)) ways.push_back({fetch, usual.stack, usual.work_threads});
  }
  add(ways);
  DriverChoices other = result.best;
  other.stack = other.stack == StackPlace::memory ? StackPlace::registers : StackPlace::memory;
  add({result.best, other});
  return result;
}

}  // namespace qtrace::gpu
