#include "experiments/commands/cli.h"

#include "experiments/commands/compare.h"
#include "experiments/commands/config.h"
#include "experiments/commands/devices.h"
#include "experiments/commands/gltf.h"
#include "experiments/commands/inspect.h"
#include "experiments/commands/keys.h"
#include "experiments/commands/rerun.h"
#include "experiments/commands/run.h"
#include "experiments/commands/status.h"
#include "experiments/commands/submit.h"
#include "experiments/runtime/stopper.h"
#include "experiments/runtime/version.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>

namespace qtrace::experiments {
namespace {

int dispatch(int argc, const char* const* argv) {
  CLI::App app("qtrace: convergence studies of reinforcement-learned light transport");
  app.require_subcommand(1);
  app.set_version_flag("--version", software());
  Action action;  // of the subcommand that is asked for
  add_run_command(app, {argv, argv + argc}, action);
  add_submit_command(app, action);
  add_inspect_command(app, action);
  add_compare_command(app, action);
  add_devices_command(app, action);
  add_rerun_command(app, action);
  add_status_command(app, action);
  add_keys_command(app, action);
  add_gltf_command(app, action);
  add_config_command(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return action();
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  try {
    return dispatch(argc, argv);
  } catch (const Stopped& stopped) {
    fmt::print(stderr, "{}\n", stopped.why);
    return stopped.exit_code;
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 1;
  }
}

}  // namespace qtrace::experiments
