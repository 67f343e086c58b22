#include "experiments/run/run_manifest.h"

#include "experiments/runtime/manifest.h"

#include <algorithm>

namespace qtrace::experiments {

Json first_manifest(const RunJob& job, const RunRecord& record) {
  const RunConfig& config = job.run.config;
  Json axes = Json::object();
  for (std::size_t i = 0; i < job.experiment.axes.size(); ++i) {
    axes[job.experiment.axes[i].name] = job.run.labels[i];
  }
  Json manifest{{"schema", kResultsSchema},
                {"status", "running"},
                {"experiment", job.experiment.name},
                {"config_file", job.experiment.file.string()},
                {"run", job.run.id},
                {"configuration", job.run.configuration},
                {"axes", axes},
                {"config", write_knobs(config)},
                {"config_hash", record.config_hash},
                {"scene", scene_json(job.scene, job.folder)},
                {"reference", {{"hash", record.reference_hash}}},
                {"reference_scene", scene_json(job.shown, job.folder)},
                {"device", device_json(job.context.device())},
                {"program", program_json()},
                {"metrics", metrics_json()},
                {"timing", timing_note()},
                {"started", record.started},
                {"warnings", Json::array()}};
  const std::string warning = light_warning(job.scene, config);
  if (!warning.empty()) manifest["warnings"].push_back(warning);
  return manifest;
}

std::string light_warning(const LoadedScene& scene, const RunConfig& config) {
  const auto& environment = config.render.environment;
  const bool lit = has_light(scene.scene) || *std::max_element(environment.begin(), environment.end()) > 0;
  return lit ? "" : fmt::format("{}: the scene has no light: the image will be black", scene.file.string());
}

}  // namespace qtrace::experiments
