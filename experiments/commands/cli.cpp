#include "experiments/commands/cli.h"

#include "engine/core/check.h"
#include "experiments/commands/compare.h"
#include "experiments/commands/config_command.h"
#include "experiments/commands/inspect.h"
#include "experiments/commands/rerun.h"
#include "experiments/commands/run_command.h"
#include "experiments/commands/status.h"
#include "experiments/commands/submit_command.h"
#include "experiments/files/text_table.h"
#include "experiments/runtime/version.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>

namespace qtrace::experiments {
namespace {

int command_devices() {
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

// `markdown`: the page docs/keys.md.
int command_keys(bool markdown) {
  const std::vector<std::string> header{"key", "type", "default", "unit", "meaning"};
  std::vector<std::vector<std::string>> rows;
  for (const KeyRow& row : list_knobs(ExperimentKeys{})) {
    rows.push_back({row.key, row.type, row.default_value, row.unit, row.help});
  }
  if (!markdown) {
    fmt::print("{}", plain_table(header, rows));
    return 0;
  }
  for (std::vector<std::string>& row : rows) {
    row[0] = '`' + row[0] + '`';
    row[2] = '`' + row[2] + '`';
  }
  fmt::print(
      "# Keys of experiment files\n\nMade by `qtrace keys --markdown`. Groups may be written nested or with "
      "a dot: `{{\"rl\": {{\"update\": \"sarsa\"}}}}` or `{{\"rl.update\": \"sarsa\"}}`.\n\n{}",
      markdown_table(header, rows, header.size()));
  return 0;
}

CLI::App* add_inspect_command(CLI::App& app, InspectOptions& options) {
  constexpr int kMostSamples = 1 << 20;
  CLI::App* inspect =
      app.add_subcommand("inspect", "Pictures of a run's cells, and of what one of them has learned");
  inspect->add_option("RUN_FOLDER", options.folder, "results/<experiment>/<run>, made with save_table")
      ->required();
  inspect->add_option("--pixel", options.pixel, "X,Y: whose cell is shown (default: the middle of the image)")
      ->delimiter(',')
      ->expected(2);
  inspect->add_option("--samples", options.samples, "paths per pixel of the true hemisphere")
      ->capture_default_str()
      ->check(CLI::Range(1, kMostSamples));
  inspect->add_option("--frame", options.frame, "after which frame the table was saved (default: the last)");
  inspect->add_option("--device", options.device, "index or part of a name, see `qtrace devices`");
  return inspect;
}

CLI::App* add_compare_command(CLI::App& app, CompareOptions& options) {
  CLI::App* compare = app.add_subcommand("compare", "Error metrics of an image against a reference");
  compare->add_option("IMAGE", options.image, "OpenEXR file: R, G, B, a layer of them, X, Y, Z or Y")
      ->required();
  compare->add_option("REFERENCE", options.reference, "the same, perhaps with variances")->required();
  compare->add_option("--layer", options.layer, "the layer or part to compare, where there are several");
  compare->add_option("--reference-layer", options.reference_layer,
                      "of the reference (default: --layer where it has that, else its main image)");
  compare->add_option("--heat", options.heat,
                      "writes the error of every pixel: .png in false colours, .exr the values");
  const auto& names = EnumNames<PixelError>::values;
  const auto choose = [&options, &names](const std::string& name) {
    options.heat_metric =
        static_cast<PixelError>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  compare->add_option_function<std::string>("--heat-metric", choose, "default: relmse")
      ->check(CLI::IsMember(std::vector<std::string>(names.begin(), names.end())));
  compare
      ->add_option("--heat-max", options.heat_top,
                   "error with the brightest colour (default: flip 1, else the 99th percentile)")
      ->check(CLI::PositiveNumber);
  return compare;
}

int dispatch(int argc, const char* const* argv) {
  CLI::App app("qtrace: convergence studies of reinforcement-learned light transport");
  app.require_subcommand(1);
  app.set_version_flag("--version", software());
  RunOptions options;
  add_run_command(app, options);
  SubmitOptions submit_options;
  CLI::App* submitted = add_submit_command(app, submit_options);
  InspectOptions inspect_options;
  CLI::App* inspect = add_inspect_command(app, inspect_options);
  CompareOptions compare_options;
  CLI::App* compare = add_compare_command(app, compare_options);
  CLI::App* devices = app.add_subcommand("devices", "List what this machine can compute on");
  RerunOptions rerun_options;
  CLI::App* again = app.add_subcommand("rerun", "Does a run again from its manifest; do the bits agree?");
  again->add_option("MANIFEST", rerun_options.manifest, "results/<experiment>/<run>/manifest.json")
      ->required();
  again->add_option("--out", rerun_options.out, "keeps the new files in this folder");
  again->add_option("--device", rerun_options.device, "index or part of a name, see `qtrace devices`");
  std::string status_folder = "results";
  CLI::App* status = app.add_subcommand("status", "How far the experiments in a folder are");
  status->add_option("RESULTS", status_folder, "results, or results/<experiment>")->capture_default_str();
  CLI::App* keys = app.add_subcommand("keys", "List the keys of experiment files");
  bool markdown = false;
  keys->add_flag("--markdown", markdown, "as a page of documentation");
  ConfigOptions config_options;
  add_config_command(app, config_options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (compare->parsed()) {
    fmt::print("{}", compare_files(compare_options));
    return 0;
  }
  if (submitted->parsed()) {
    fmt::print("{}", submit(submit_options));
    return 0;
  }
  if (inspect->parsed()) {
    Progress progress(Progress::detect(false));
    fmt::print("{}", inspect_run(inspect_options, progress));
    return 0;
  }
  if (again->parsed()) {
    Progress progress(Progress::detect(false));
    const RerunResult result = rerun(rerun_options, progress);
    fmt::print("{}", result.text);
    return result.agrees ? 0 : 1;
  }
  if (status->parsed()) {
    fmt::print("{}", status_text(status_folder));
    return 0;
  }
  if (devices->parsed()) return command_devices();
  if (keys->parsed()) return command_keys(markdown);
  if (config_options.command->parsed()) return config_command(config_options);
  return run_command(options);
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
