#include "experiments/commands/keys.h"

#include "experiments/config/experiment_config.h"
#include "experiments/files/text_table.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>

namespace qtrace::experiments {
namespace {

// `markdown`: the page docs/keys.md.
int print_keys(bool markdown) {
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

}  // namespace

void add_keys_command(CLI::App& app, Action& action) {
  CLI::App* keys = app.add_subcommand("keys", "List the keys of experiment files");
  const auto markdown = std::make_shared<bool>(false);
  keys->add_flag("--markdown", *markdown, "as a page of documentation");
  keys->callback([&action, markdown] { action = [markdown] { return print_keys(*markdown); }; });
}

}  // namespace qtrace::experiments
