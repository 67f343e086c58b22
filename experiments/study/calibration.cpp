#include "experiments/study/calibration.h"

#include "engine/tracer/tracer.h"

#include <algorithm>
#include <chrono>
#include <set>

namespace qtrace::experiments {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostMeasured = 32;    // configurations; the others are taken for their mean
constexpr double kLongestMeasurement = 0.5;  // seconds of frames per configuration
constexpr int kMostFrames = 16;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

Speed measure_speed(const gpu::Context& context, const Scene& scene, const RenderSettings& settings) {
  Speed speed;
  auto start = Clock::now();
  Tracer tracer(context, scene, settings);
  tracer.render_frame();
  context.finish();
  speed.setup_s = seconds_since(start);
  start = Clock::now();
  int frames = 0;
  do {
    tracer.render_frame();
    context.finish();
    ++frames;
  } while (frames < kMostFrames && seconds_since(start) < kLongestMeasurement);
  speed.frame_s = seconds_since(start) / frames;
  return speed;
}

Calibration::Calibration(const Experiment& experiment, const std::vector<Turn>& turns,
                         const gpu::Context& context, const ExperimentInputs& inputs, Progress& progress) {
  std::vector<Turn> firsts;  // of each configuration
  std::set<std::string> seen;
  for (const Turn& turn : turns) {
    if (seen.insert(experiment.runs[turn.place].configuration).second) firsts.push_back(turn);
  }
  configurations_ = firsts.size();
  const std::size_t step = std::max<std::size_t>(1, (configurations_ + kMostMeasured - 1) / kMostMeasured);
  for (std::size_t i = 0; i < configurations_; i += step) {
    const Run& run = experiment.runs[firsts[i].place];
    progress.note(fmt::format("measuring {}", run.configuration));
    speeds_[run.configuration] = measure_speed(context, inputs.of(firsts[i]).scene->scene, run.config.render);
  }
}

double Calibration::seconds(const Run& run, int frames) const {
  if (frames == 0) return 0;
  const auto own = speeds_.find(run.configuration);
  const Speed speed = own == speeds_.end() ? mean() : own->second;
  return speed.setup_s + speed.frame_s * frames;
}

std::string Calibration::text() const {
  return configurations_ == speeds_.size()
             ? fmt::format("measured on all {} configurations", configurations_)
             : fmt::format("measured on {} of its {} configurations", speeds_.size(), configurations_);
}

Speed Calibration::mean() const {
  Speed sum;
  for (const auto& [configuration, speed] : speeds_)
    sum.setup_s += speed.setup_s, sum.frame_s += speed.frame_s;
  const auto count = static_cast<double>(std::max<std::size_t>(1, speeds_.size()));
  return {sum.setup_s / count, sum.frame_s / count};
}

}  // namespace qtrace::experiments
