#include "experiments/commands/devices.h"

#include "engine/core/check.h"
#include "engine/gpu/context.h"
#include "experiments/files/text_table.h"

#include <CLI/CLI.hpp>

#include <cstdio>

namespace qtrace::experiments {
namespace {

int print_devices() {
  std::vector<std::vector<std::string>> rows;
  bool usable = false;
  for (const gpu::DeviceInfo& device : gpu::list_devices()) {
    usable = usable || device.problem.empty();
    rows.push_back({std::to_string(device.index), device.renderer, device.gl_version, device.platform,
                    device.software ? "software" : "hardware",
                    device.problem.empty() ? "usable" : "not usable: " + device.problem});
  }
  fmt::print("{}", plain_table({"index", "renderer", "OpenGL", "platform", "kind", "state"}, rows));
  check(usable,
        "no device can be used: OpenGL 4.5 through EGL is needed; Mesa's llvmpipe needs no hardware "
        "(Debian: libegl-mesa0 and libgl1-mesa-dri)");
  return 0;
}

}  // namespace

void add_devices_command(CLI::App& app, Action& action) {
  CLI::App* devices = app.add_subcommand("devices", "List what this machine can compute on");
  devices->callback([&action] { action = print_devices; });
}

}  // namespace qtrace::experiments
