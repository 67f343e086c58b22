// What may go wrong in a night: a run that fails, a frame that hangs, a device that is reset, files that
// vanish.
#include "tests/support/device.h"
#include "tests/system/run_program.h"

#include "experiments/reference/reference_store.h"
#include "experiments/run/run.h"

#include <filesystem>

namespace qtrace::tests {
namespace {

namespace fs = std::filesystem;
using namespace experiments;

class Faults : public RunProgram {};

TEST_F(Faults, AFrameThatTakesTooLongFailsItsRunAlone) {
  if (!test::device().device().software) GTEST_SKIP() << "a GPU may render the slow frame in time";
  folder_.write("hangs.json",
                R"({"name": "hangs", "scene": "scene.gltf", "width": 8, "height": 8, "frames": 4,
    "max_bounces": 3, "reference": {"frames": 8},
    "sweep": [{"run": {"before": {}, "slow": {"frame_timeout_s": 0.02, "width": 500, "height": 500, "max_bounces": 10,
                                              "russian_roulette_start": 10, "reference.frames": 2, "sampler": "bsdf", "nee": "two_ray"},
                       "after": {"max_bounces": 2}}}]})");
  const Outcome outcome = run_qtrace({"run", "hangs.json"}, folder_.path());
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  const auto rows = parse_csv(folder_.read("results/hangs/summary.csv"));
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].at("status"), "finished");
  EXPECT_EQ(rows[1].at("status"), "failed");
  EXPECT_EQ(rows[1].at("reason"), "frame 1 took longer than frame_timeout_s, 0.02 s");
  EXPECT_EQ(rows[2].at("status"), "finished");
  EXPECT_EQ(json("results/hangs/run=slow/manifest.json").at("reason"), rows[1].at("reason"));
}

TEST_F(Faults, TheFirstFailureEndsTheWorkWhereThatIsAskedFor) {
  folder_.write("fails.json",
                R"({"name": "fails", "scene": "scene.gltf", "width": 8, "height": 8, "frames": 4,
    "reference": {"frames": 8}, "sweep": [{"seed": [1, 2, 3]}]})");
  ASSERT_EQ(run_qtrace({"run", "fails.json"}, folder_.path()).exit_code, 0);
  // A file where the run's folder should be.
  for (const char* run : {"seed=1", "seed=2"}) {
    fs::remove_all(folder_ / (std::string("results/fails/") + run));
    folder_.write(std::string("results/fails/") + run, "in the way");
  }
  const Outcome fast = run_qtrace({"run", "fails.json", "--fail-fast"}, folder_.path());
  EXPECT_EQ(fast.exit_code, 1);
  EXPECT_TRUE(contains(fast.err, "seed=1 failed (--fail-fast)")) << fast.err;
  const Outcome all = run_qtrace({"run", "fails.json"}, folder_.path());
  EXPECT_EQ(all.exit_code, 1);
  EXPECT_TRUE(contains(all.out, "2 failed") || contains(all.out, "Failed runs:\n- seed=1: ")) << all.out;
  fs::remove(folder_ / "results/fails/seed=1");
  fs::remove(folder_ / "results/fails/seed=2");
  EXPECT_EQ(run_qtrace({"run", "fails.json"}, folder_.path()).exit_code, 0);
}

TEST_F(Faults, AFolderThatCannotBeWrittenIsNamedBeforeAnyWork) {
  folder_.write("results/file", "");
  const Outcome outcome = run("a", "", {"--out", "results/file"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_TRUE(contains(outcome.err, "results/file")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "cannot be made a folder")) << outcome.err;
}

// The scene is read once, before anything is rendered.
TEST_F(Faults, ASceneThatVanishesIsNotMissed) {
  folder_.write("v.json", R"({"name": "v", "scene": "scene.gltf", "width": 64, "height": 64, "frames": 32,
    "reference": {"frames": 8}, "sweep": [{"seed": [1, 2]}]})");
  const auto outcome = signal_qtrace_when(0, {"run", "v.json"}, folder_.path(), [&] {
    if (!fs::exists(folder_ / "results/v/seed=1/manifest.json")) return false;
    fs::remove(folder_ / "scene.gltf");
    fs::remove(folder_ / "scene.bin");
    return true;
  });
  ASSERT_TRUE(outcome.has_value());
  EXPECT_EQ(outcome->exit_code, 0) << outcome->err;
}

// Files that say that the context is lost, once, after a frame was rendered.
class LosingFiles : public RunFiles {
 public:
  LosingFiles(const fs::path& folder, const ExrMetadata& metadata, FileQueue& files, int& losses)
      : RunFiles(folder, metadata, files), losses_(losses) {}
  void write_snapshot(int frame, const RadianceImage& image, const RadianceImage* filtered) const override {
    RunFiles::write_snapshot(frame, image, filtered);
    if (frame == 4 && losses_++ == 0) throw gpu::ContextLost("the device was reset");
  }

 private:
  int& losses_;
};

TEST_F(Faults, ALostContextIsRenewedAndTheRunGoesOnToTheSameBits) {
  folder_.write("lost.json",
                R"({"name": "lost", "scene": "scene.gltf", "width": 16, "height": 16, "frames": 8,
    "checkpoint_s": 0.001, "reference": {"frames": 8}})");
  const Experiment experiment = load_experiment(folder_ / "lost.json");
  const experiments::Run& run = experiment.runs.front();
  Progress progress(Progress::Mode::quiet);
  SceneStore scenes;
  const LoadedScene& scene = scenes.load(experiment.scene_file(run));
  const Stopper stopper;
  FileQueue files;
  int losses = 0;
  gpu::Context& context = test::device();
  const ReferenceSpec spec = reference_spec(run.config, scene.hash);
  const RunInputs inputs = run_inputs(run, scene, scene, spec, context.device());
  const auto execute = [&](const std::string& place, bool loses) {
    ReferenceStore references(context, folder_.path(), stopper, progress);
    const auto get = [&] { return references.get(spec, scene, experiment.folder()); };
    const auto losing = [&](const fs::path& folder, const ExrMetadata& metadata, FileQueue& queue) {
      return std::make_unique<LosingFiles>(folder, metadata, queue, losses);
    };
    RunJob job{.context = context,
               .experiment = experiment,
               .run = run,
               .inputs = inputs,
               .get_reference = get,
               .folder = folder_ / place,
               .files = files,
               .label = place};
    if (loses) job.make_files = losing;
    return execute_run(job, progress).record;
  };
  EXPECT_EQ(execute("whole", false).status, RunStatus::finished);
  EXPECT_THROW(execute("lost", true), gpu::ContextLost);
  files.flush();
  context.renew();
  const RunRecord again = execute("lost", true);
  files.flush();
  EXPECT_EQ(again.status, RunStatus::finished) << again.reason;
  EXPECT_GT(json("lost/manifest.json").at("resumed_after_frame"), 0);
  EXPECT_EQ(folder_.read("whole/frame_000008.exr"), folder_.read("lost/frame_000008.exr"));
}

}  // namespace
}  // namespace qtrace::tests
