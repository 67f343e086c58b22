#include "experiments/runtime/manifest.h"

#include "experiments/runtime/version.h"

#include <fmt/chrono.h>

#include <ctime>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

Json place_json(const fs::path& file, const fs::path& folder) {
  const fs::path here = fs::absolute(folder).lexically_normal();
  return {{"file", file.string()},
          {"from_here", fs::absolute(file).lexically_normal().lexically_relative(here).string()}};
}

}  // namespace

std::string utc_now() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

Json program_json() {
  return {{"name", "qtrace"}, {"version", version()}, {"commit", commit()}, {"binary", binary_hash()}};
}

Json device_json(const gpu::DeviceInfo& device) {
  return {{"renderer", device.renderer},
          {"vendor", device.vendor},
          {"gl_version", device.gl_version},
          {"platform", device.platform},
          {"software", device.software},
          {"buffer_fetch", gpu::fetch_name(device.choices.fetch)},
          {"traversal_stack", gpu::stack_name(device.choices.stack)},
          {"work_threads", device.choices.work_threads},
          {"loop_limit", device.loop_limit == 0 ? Json() : Json(device.loop_limit)}};
}

Json scene_json(const LoadedScene& scene, const std::filesystem::path& folder) {
  Json json = place_json(scene.file, folder);
  json.update({{"hash", scene.hash},
               {"triangles", scene.scene.triangles.size()},
               {"objects", scene.scene.objects.size()},
               {"materials", scene.scene.materials.size()},
               {"warnings", scene.scene.warnings}});
  if (!scene.environment_file.empty()) json["environment"] = place_json(scene.environment_file, folder);
  return json;
}

std::string timing_note() {
  return "Times hold tracing and, for RL, all learning of each frame; building structures, compiling "
         "shaders, "
         "readback, filtering, metrics and files are outside. host: host clock around a frame until its work "
         "is done; "
         "gpu: "
         "GL timestamps around the same. Warm-up frames are in totals and not in medians and percentiles.";
}

std::string device_text(const gpu::DeviceInfo& device) {
  return fmt::format("{}, OpenGL {}, {}", device.renderer, device.gl_version,
                     device.software ? "software: computes on the CPU" : "hardware");
}

}  // namespace qtrace::experiments
