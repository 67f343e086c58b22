// What times leave out, shown by making it slow.
#include "tests/support/device.h"
#include "tests/system/small_scene.h"

#include "experiments/reference/reference_store.h"
#include "experiments/run/run.h"
#include "experiments/study/experiment.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace qtrace::tests {
namespace {

using namespace experiments;

constexpr double kDelay = 0.2;  // seconds per snapshot; three snapshots

class SlowFiles : public RunFiles {
 public:
  using RunFiles::RunFiles;
  void write_snapshot(int frame, const RadianceImage& image, const RadianceImage* filtered) const override {
    std::this_thread::sleep_for(std::chrono::duration<double>(kDelay));
    RunFiles::write_snapshot(frame, image, filtered);
  }
};

// A small run takes a few milliseconds, the writer 0.6 s: were the writing inside any time, it would show.
TEST(Timing, ASlowWriterChangesNoTime) {
  const TempFolder folder;
  write_small_scene(folder, "scene");
  folder.write("slow.json", small_config("slow"));
  const Experiment experiment = load_experiment(folder / "slow.json");
  const experiments::Run& run = experiment.runs.front();
  Progress progress(Progress::Mode::quiet);
  SceneStore scenes;
  const LoadedScene& scene = scenes.load(experiment.scene_file(run));
  const Stopper stopper;
  ReferenceStore references(test::device(), folder.path(), stopper, progress);
  const ReferenceSpec spec = reference_spec(run.config, scene.hash);
  const RunInputs inputs = run_inputs(run, scene, scene, spec, test::device().device());
  const auto reference = [&] { return references.get(spec, scene, experiment.folder()); };
  reference();
  FileQueue files;
  const auto make_files = [](const std::filesystem::path& place, const ExrMetadata& metadata,
                             FileQueue& queue) {
    return std::make_unique<SlowFiles>(place, metadata, queue);
  };
  const auto start = std::chrono::steady_clock::now();
  const RunRecord record = execute_run({.context = test::device(),
                                        .experiment = experiment,
                                        .run = run,
                                        .inputs = inputs,
                                        .get_reference = reference,
                                        .folder = folder / "run",
                                        .files = files,
                                        .label = "slow",
                                        .make_files = make_files},
                                       progress)
                               .record;
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  ASSERT_EQ(record.status, RunStatus::finished) << record.reason;
  ASSERT_EQ(record.snapshots.size(), 3U);
  EXPECT_GT(wall.count(), 3 * kDelay);
  EXPECT_LT(record.elapsed_s() + record.setup_s, wall.count() - 3 * kDelay);
  EXPECT_LT(record.gpu_elapsed_s(), wall.count() - 3 * kDelay);
  for (const SnapshotRecord& snapshot : record.snapshots) EXPECT_LE(snapshot.elapsed_s, record.elapsed_s());
}

}  // namespace
}  // namespace qtrace::tests
