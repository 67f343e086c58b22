#include "experiments/commands/slurm_scripts.h"

#include "engine/core/check.h"
#include "experiments/runtime/subprocess.h"

#include <optional>
#include <regex>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

void check_one_line(std::string_view what, const std::string& text) {
  check(text.find('\n') == std::string::npos, "{} holds a line break, which no line of a script can: '{}'",
        what, text);
}

// Of Slurm's MIN, MIN:SEC, HOUR:MIN:SEC, DAY-HOUR, DAY-HOUR:MIN and DAY-HOUR:MIN:SEC; nothing for other
// forms, which sbatch judges.
std::optional<long> seconds_of(const std::string& time) {
  static const std::regex form(R"((?:(\d{1,4})-)?(\d{1,6})(?::(\d{1,6}))?(?::(\d{1,6}))?)");
  std::smatch parts;
  if (!std::regex_match(time, parts, form)) return std::nullopt;
  const auto part = [&parts](std::size_t i) { return parts[i].matched ? std::stol(parts[i]) : 0L; };
  const bool has_hours = parts[1].matched || parts[4].matched;
  if (!has_hours) return 60 * part(2) + part(3);
  return 86400 * part(1) + 3600 * part(2) + 60 * part(3) + part(4);
}

void check_time(const std::string& time) {
  check_one_line("--time", time);
  const std::optional<long> seconds = seconds_of(time);
  check(!seconds || *seconds >= kLeastSeconds,
        "--time {} is {} s, but must be at least {} s: a job stops {} s before its end, or up to a minute "
        "earlier, to write a checkpoint; two hours are 2:00:00",
        time, seconds.value_or(0L), kLeastSeconds, kWarningSeconds);
}

// One word of an #SBATCH line: sbatch knows quotes and backslashes there, but no variables.
std::string sbatch_word(const std::string& text) {
  std::string word = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') word += '\\';
    word += c;
  }
  return word + '"';
}

// Slurm tells every process of a job to end (TERM) when it is cancelled, preempted or out of time, the
// program as well as the script, and puts a preempted one back into the queue itself. Only the warning before
// the end of its time is USR1, and goes to the script alone: the one case in which the script asks for
// another turn. So what scancel ends stays ended. The script must not pass TERM on: a second one ends the
// program without a checkpoint.
constexpr const char* kTraps = R"(
trap 'out_of_time=1; kill -TERM "$!"' USR1
trap : TERM
)";

// `wait` returns at every signal, hence the loop. The job id of an array's last task is that of the array, by
// which scontrol would queue all its tasks again: a task is named by the array's id and its own number.
constexpr const char* kWaitForProgram = R"(
while kill -0 "$!" 2>/dev/null; do wait "$!"; done
wait "$!"
code=$?
task=${SLURM_ARRAY_JOB_ID:+${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID}
if [ -n "${out_of_time:-}" ] && [ "$code" -eq 143 ]; then scontrol requeue "${task:-$SLURM_JOB_ID}"; fi
exit "$code"
)";

class Writer {
 public:
  Writer(const Experiment& experiment, const SubmitOptions& options, const fs::path& program,
         const fs::path& folder)
      : experiment_(experiment), options_(options), program_(program), folder_(folder) {}

  // `option` is the stage's own for sbatch, `part` its own for qtrace run, both ready for their lines.
  SlurmScript script(const std::string& stage, const std::string& log, const std::string& option,
                     const std::string& part) const {
    std::string text = "#!/bin/bash\n# Written by qtrace submit.\n";
    const auto line = [&text](const std::string& words) { text += "#SBATCH " + words + '\n'; };
    line("--job-name=" + sbatch_word(fmt::format("{} {}", experiment_.name, stage)));
    line("--chdir=" + sbatch_word(folder_.string()));
    line("--output=" + log);
    line("--open-mode=append");
    if (!option.empty()) line(option);
    line("--requeue");
    line(fmt::format("--signal=B:USR1@{}", kWarningSeconds));
    line(fmt::format("--cpus-per-task={}", options_.cpus));
    if (!options_.time.empty()) line("--time=" + sbatch_word(options_.time));
    if (!options_.partition.empty()) line("--partition=" + sbatch_word(options_.partition));
    for (const std::string& more : options_.sbatch) line(more);
    // llvmpipe's threads: it would take all processors of the node where Slurm does not confine it.
    text += "\nexport LP_NUM_THREADS=\"${SLURM_CPUS_PER_TASK:-1}\"\n";
    text += kTraps + command() + ' ' + part + " &" + kWaitForProgram;
    return {stage, text};
  }

 private:
  std::string command() const {
    std::string words = shell_word(program_.string()) + " run " +
                        shell_word(fs::absolute(experiment_.file).lexically_normal().string());
    for (const std::string& set : options_.sets) words += " --set " + shell_word(set);
    words += " --out " + shell_word(fs::absolute(options_.out).lexically_normal().string());
    if (!options_.device.empty()) words += " --device " + shell_word(options_.device);
    return words;
  }

  const Experiment& experiment_;
  const SubmitOptions& options_;
  const fs::path& program_;
  const fs::path& folder_;
};

}  // namespace

std::vector<SlurmScript> slurm_scripts(const Experiment& experiment, const SubmitOptions& options,
                                       const fs::path& program, const fs::path& folder) {
  check_one_line("the results' folder", folder.string());
  check_time(options.time);
  check_one_line("--partition", options.partition);
  for (const std::string& more : options.sbatch) check_one_line("--sbatch", more);
  const Writer writer(experiment, options, program, folder);
  return {writer.script("references", "references.log", "", "--references-only"),
          writer.script("shards", "shard-%a.log", fmt::format("--array=1-{}", options.shards),
                        fmt::format("--shard \"$SLURM_ARRAY_TASK_ID/{}\"", options.shards)),
          writer.script("merge", "merge.log", "", "--merge")};
}

}  // namespace qtrace::experiments
