#include "experiments/run/run.h"

#include "experiments/files/atomic_file.h"
#include "experiments/run/execution.h"
#include "experiments/config/config_hash.h"
#include "experiments/runtime/manifest.h"

namespace qtrace::experiments {

std::unique_ptr<RunFiles> make_run_files(const std::filesystem::path& folder, const ExrMetadata& metadata,
                                         FileQueue& files) {
  return std::make_unique<RunFiles>(folder, metadata, files);
}

double run_work(const RunConfig& config) {
  return static_cast<double>(config.render.width) * config.render.height * config.frames;
}

RunEnd execute_run(const RunJob& job, Progress& progress) {
  RunEnd result;
  RunRecord& record = result.record;
  record.run = job.run;
  record.scene = job.scene.scene.name;
  record.status = "running";
  record.started = utc_now();
  record.config_hash = config_hash(job.run.config, job.scene.hash);
  record.reference_hash = reference_spec(job.run.config, job.shown.hash).hash;
  std::optional<Execution> execution;
  const auto close = [&](const std::string& status, const std::string& reason) {
    record.status = status;
    record.reason = reason;
    try {
      if (execution) execution->close(status, reason);
    } catch (const std::exception& error) {
      progress.warning(fmt::format("{}: {}", job.run.id, error.what()));
    }
  };
  const auto end = [&] {
    if (execution && execution->begun()) return progress.end();
    progress.plan(-run_work(job.run.config));  // nothing of it will be done
  };
  try {
    execution.emplace(job, record);
    execution->run(progress);
    const bool is_whole = execution->frames() == job.run.config.frames;
    execution->close(is_whole ? "finished" : kPartial, "");
  } catch (const Stopped& stopped) {
    close(kPartial, stopped.why);
    result.stopped = stopped;
  } catch (const DiskFull& error) {
    close(kPartial, error.what());
    result.stopped = Stopped{error.what(), 1};
  } catch (const gpu::ContextLost&) {
    progress.end();
    throw;
  } catch (const std::exception& error) {
    close("failed", error.what());
  }
  end();
  return result;
}

}  // namespace qtrace::experiments
