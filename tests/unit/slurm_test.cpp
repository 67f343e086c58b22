// The scripts of a submission, run by bash as Slurm would: what reaches the program, and what signals do.
#include "experiments/commands/submit.h"

#include "experiments/runtime/subprocess.h"
#include "tests/system/temp_folder.h"

#include <gtest/gtest.h>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

// In place of qtrace: keeps its words. Where it is told what to end with at TERM it waits for that, and a
// moment longer for a second one.
constexpr const char* kProgram = R"~(#!/bin/bash
here=$(dirname "$0")
printf '%s\n' "$LP_NUM_THREADS" "$@" > "$here/words.new"
trap 'echo TERM >> "$here/signals"' TERM
mv "$here/words.new" "$here/words"
[ -e "$here/at_term" ] || exit $(cat "$here/code")
pause() { sleep "$1" & wait $!; kill $! 2>/dev/null; }  # a signal ends it, and is handled at once
pause 20
for i in {1..20}; do pause 0.01; done
echo end >> "$here/signals"
exit $(cat "$here/at_term")
)~";

constexpr const char* kScontrol = "#!/bin/bash\necho \"$*\" >> \"$(dirname \"$0\")/scontrol_words\"\n";

// Runs a script as a job, sends a signal to it ("USR1") or to all its processes ("-TERM") when the program
// has started, and tells how the job ended.
constexpr const char* kJob = R"(
export PATH="$1:$PATH" SLURM_JOB_ID=77 SLURM_CPUS_PER_TASK=3
if [ -n "$3" ]; then export SLURM_ARRAY_JOB_ID=77 SLURM_ARRAY_TASK_ID=$3; fi  # as Slurm does for the last task
set -m  # a process group of its own
bash "$1/job.sbatch" & job=$!
if [ -n "$2" ]; then
  until [ -e "$1/words" ] || ! kill -0 $job; do sleep 0.01; done
  case $2 in -*) kill "$2" -- -$job ;; *) kill -"$2" $job ;; esac
fi
wait $job
)";

class SlurmScripts : public testing::Test {
 protected:
  SlurmScripts() {
    folder_.write("a $b's.json", R"({"name": "x", "scene": "s.gltf", "sweep": [{"seed": [1, 2, 3]}]})");
    options_.shards = 3;
    options_.out = (folder_ / "out \"1\" %j").string();
    write_program("qtrace", kProgram);
    write_program("scontrol", kScontrol);
  }

  void write_program(const std::string& name, const std::string& text) const {
    fs::permissions(folder_.write(name, text), fs::perms::owner_all);
  }

  std::vector<SlurmScript> scripts() const {
    return slurm_scripts(load_experiment(folder_ / "a $b's.json"), options_, folder_ / "qtrace",
                         fs::path(options_.out) / "x" / "slurm");
  }

  // The exit code of the array's script, as its task 2.
  int run_job(const std::string& signal) const { return run_job(signal, 1, "2"); }

  int run_job(const std::string& signal, std::size_t script, const std::string& task) const {
    folder_.write("job.sbatch", scripts().at(script).text);
    return run_program({"bash", "-c", kJob, "bash", folder_.path().string(), signal, task}).exit_code;
  }

  bool asked_for_another_turn() const { return fs::exists(folder_ / "scontrol_words"); }

  tests::TempFolder folder_;
  SubmitOptions options_;
};

TEST_F(SlurmScripts, PassAllWordsAsTheyWere) {
  options_.sets = {"frames=8", "sweep.seed=[1, 2, 3]"};
  options_.device = "a b";
  folder_.write("code", "0");
  EXPECT_EQ(run_job(""), 0);
  EXPECT_EQ(folder_.read("words"),
            fmt::format("3\nrun\n{}\n--set\nframes=8\n--set\nsweep.seed=[1, 2, 3]\n--out\n{}\n--device\na "
                        "b\n--shard\n2/3\n",
                        (folder_ / "a $b's.json").string(), options_.out));
}

TEST_F(SlurmScripts, SayWhatSbatchNeedsToKnow) {
  options_.time = "2:00:00";
  options_.partition = "long";
  options_.cpus = 4;
  options_.sbatch = {"--mem=4G --gres=gpu:1", "--exclusive"};
  const std::vector<SlurmScript> all = scripts();
  ASSERT_EQ(all.size(), 3u);
  for (const SlurmScript& script : all) {
    const std::string slurm_folder = folder_.path().string() + "/out \\\"1\\\" %j/x/slurm";
    for (const std::string& line : {"--job-name=\"x " + script.stage + '"', "--chdir=\"" + slurm_folder + '"',
                                    std::string("--open-mode=append"), std::string("--requeue"),
                                    std::string("--signal=B:USR1@60"), std::string("--cpus-per-task=4"),
                                    std::string("--time=\"2:00:00\""), std::string("--partition=\"long\""),
                                    std::string("--mem=4G --gres=gpu:1"), std::string("--exclusive")}) {
      EXPECT_NE(script.text.find("\n#SBATCH " + line + '\n'), std::string::npos) << line << script.text;
    }
    // sbatch reads no further than the first command.
    EXPECT_LT(script.text.rfind("#SBATCH"), script.text.find("\nexport"));
  }
  EXPECT_NE(all[0].text.find(" --references-only &\n"), std::string::npos);
  EXPECT_NE(all[1].text.find("\n#SBATCH --array=1-3\n"), std::string::npos);
  EXPECT_NE(all[2].text.find(" --merge &\n"), std::string::npos);
}

TEST_F(SlurmScripts, EndAsTheProgramEnds) {
  folder_.write("code", "1");
  EXPECT_EQ(run_job(""), 1);
  EXPECT_FALSE(asked_for_another_turn());
}

TEST_F(SlurmScripts, AskForAnotherTurnWhenTheTimeIsUp) {
  folder_.write("at_term", "143");
  EXPECT_EQ(run_job("USR1"), 143);
  ASSERT_TRUE(asked_for_another_turn());
  EXPECT_EQ(folder_.read("scontrol_words"), "requeue 77_2\n");  // not 77: that is the whole array
  EXPECT_EQ(folder_.read("signals"), "TERM\nend\n");
}

TEST_F(SlurmScripts, OfOneTaskAskForTheirJob) {
  folder_.write("at_term", "143");
  for (const std::size_t script : {0U, 2U}) {
    EXPECT_EQ(run_job("USR1", script, ""), 143);
    EXPECT_EQ(folder_.read("scontrol_words"), "requeue 77\n");
    fs::remove(folder_ / "scontrol_words");
    fs::remove(folder_ / "words");
  }
}

TEST_F(SlurmScripts, DoNotReturnWhenTheyAreCancelled) {
  folder_.write("at_term", "143");
  EXPECT_EQ(run_job("-TERM"), 143);
  EXPECT_FALSE(asked_for_another_turn());
  EXPECT_EQ(folder_.read("signals"), "TERM\nend\n");  // a second TERM would end it without a checkpoint
}

TEST_F(SlurmScripts, NeedNoOtherTurnWhenTheProgramWasJustDone) {
  folder_.write("at_term", "0");
  EXPECT_EQ(run_job("USR1"), 0);
  EXPECT_FALSE(asked_for_another_turn());
}

TEST_F(SlurmScripts, RefuseTimesThatAreOverBeforeAnythingIsDone) {
  for (const char* time : {"4", "2:00", "4:59", "0:04:59", "0-0:4", "0-0", "0-0:4:59"}) {
    options_.time = time;
    EXPECT_THROW(scripts(), Error) << time;
  }
  // The last two are for sbatch to judge.
  for (const char* time :
       {"", "5", "5:00", "0:05:00", "2:00:00", "1-0", "0-1", "0-0:5", "UNLIMITED", "soon"}) {
    options_.time = time;
    EXPECT_NO_THROW(scripts()) << time;
  }
}

TEST_F(SlurmScripts, RefuseLineBreaksInTheirOptions) {
  options_.partition = "a\n#SBATCH --mem=1";
  EXPECT_THROW(scripts(), Error);
  options_.partition.clear();
  options_.sbatch = {"a\nb"};
  EXPECT_THROW(scripts(), Error);
}

}  // namespace
}  // namespace qtrace::experiments
