#include "experiments/commands/subcommand.h"

#include <CLI/CLI.hpp>

namespace qtrace::experiments {

void add_repeated_option(CLI::App& command, const std::string& name, std::vector<std::string>& values,
                         const std::string& help) {
  command.add_option(name, values, help)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
}

}  // namespace qtrace::experiments
