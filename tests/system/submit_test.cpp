// qtrace submit as its user calls it, with stand-ins for Slurm's commands; tests/slurm has the real ones.
#include "tests/system/run_program.h"

#include <cstdlib>

namespace qtrace::tests {
namespace {

namespace fs = std::filesystem;

// Keeps its words, and refuses the script that `refused` names.
constexpr const char* kSbatch = R"~(#!/bin/bash
here=$(dirname "$0")
printf '%s ' "$@" >> "$here/calls"; echo >> "$here/calls"
for last; do :; done
if [ -e "$here/refused" ] && [ "$(basename "$last")" = "$(cat "$here/refused")" ]; then
  echo "sbatch: error: invalid partition specified: p" >&2
  exit 1
fi
echo "$((100 + $(wc -l < "$here/calls")));mycluster"
)~";

constexpr const char* kScancel = "#!/bin/bash\necho \"scancel $*\" >> \"$(dirname \"$0\")/calls\"\n";

class Submit : public RunProgram {
 protected:
  Submit() : path_(std::getenv("PATH")) {
    folder_.write("c.json", small_config("x", R"("sweep": [{"seed": [1, 2, 3, 4]}], )"));
    fs::permissions(folder_.write("bin/sbatch", kSbatch), fs::perms::owner_all);
    fs::permissions(folder_.write("bin/scancel", kScancel), fs::perms::owner_all);
    set_path((folder_ / "bin").string() + ':' + path_);
  }
  ~Submit() override { set_path(path_); }

  static void set_path(const std::string& path) { ::setenv("PATH", path.c_str(), 1); }

  Outcome submit(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"submit", "c.json", "--slurm"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_qtrace(arguments, folder_.path());
  }

  void expect_refused(const std::vector<std::string>& more, const std::string& message) const {
    const std::vector<std::string> before = tree(folder_.path());
    const Outcome outcome = submit(more);
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_TRUE(contains(outcome.err, message)) << outcome.err;
    EXPECT_EQ(tree(folder_.path()), before);
  }

  std::string path_;
};

TEST_F(Submit, QueuesReferencesThenTheArrayThenTheMerge) {
  const Outcome outcome = submit({"--shards", "2", "--out", "o"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string slurm = (fs::canonical(folder_.path()) / "o/x/slurm").string();
  EXPECT_EQ(folder_.read("bin/calls"),
            "--parsable " + slurm + "/references.sbatch \n" +
                "--parsable --dependency=afterok:101 --kill-on-invalid-dep=yes " + slurm +
                "/shards.sbatch \n" + "--parsable --dependency=afterany:102 " + slurm + "/merge.sbatch \n");
  EXPECT_TRUE(contains(outcome.out, "x: 4 runs in 2 shards")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "squeue --jobs 101,102,103")) << outcome.out;
  EXPECT_TRUE(contains(folder_.read("o/x/slurm/shards.sbatch"), "#SBATCH --array=1-2\n"));
}

TEST_F(Submit, DryRunPrintsTheScriptsAndDoesNothing) {
  const std::vector<std::string> before = tree(folder_.path());
  const Outcome outcome = submit({"--shards", "4", "--dry-run", "--sbatch", "--mem=4G", "--set", "frames=3"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* part : {"--references-only", "#SBATCH --array=1-4\n", "--shard \"$SLURM_ARRAY_TASK_ID/4\"",
                           "--merge", "#SBATCH --mem=4G\n", "--set 'frames=3'"}) {
    EXPECT_TRUE(contains(outcome.out, part)) << part;
  }
  EXPECT_EQ(tree(folder_.path()), before);
}

TEST_F(Submit, TakesBackWhatIsQueuedWhereSlurmRefusesALaterJob) {
  folder_.write("bin/refused", "shards.sbatch");
  const Outcome outcome = submit({"--shards", "2"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_TRUE(contains(outcome.err, "shards.sbatch: Slurm refuses the job: sbatch: error: invalid partition"))
      << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "101, are cancelled again")) << outcome.err;
  EXPECT_TRUE(contains(folder_.read("bin/calls"), "scancel 101\n"));
}

TEST_F(Submit, RefusesWhatIsWrongBeforeAnythingIsWritten) {
  expect_refused({"--shards", "5"}, "--shards is 5, but must be from 1 to 4, the number of runs of c.json");
  expect_refused({"--shards", "0"}, "--shards is 0, but must be from 1 to 4");
  expect_refused({"--shards", "2", "--set", "frame=2"}, "unknown key 'frame'; did you mean 'frames'?");
  expect_refused({"--shards", "2", "--set", "scene=none.gltf"}, "none.gltf: no such scene");
  expect_refused({"c.json", "--shards", "2"}, "c.json and c.json are both called 'x'");
  set_path((folder_ / "empty").string());
  expect_refused({"--shards", "2"}, "sbatch is not on the PATH");
}

TEST_F(Submit, WrongUsageExitsWithTwo) {
  EXPECT_EQ(run_qtrace({"submit", "c.json", "--shards", "2"}, folder_.path()).exit_code, 2);
  EXPECT_EQ(submit({}).exit_code, 2);
  EXPECT_EQ(submit({"--shards", "2", "--cpus", "0"}).exit_code, 2);
}

}  // namespace
}  // namespace qtrace::tests
