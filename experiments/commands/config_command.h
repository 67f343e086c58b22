// `qtrace config`: what is right about configs, without rendering.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace qtrace::experiments {

struct ConfigOptions {
  CLI::App* command = nullptr;
  CLI::App* schema = nullptr;
  CLI::App* check = nullptr;
  std::vector<std::string> files;
  std::vector<std::string> sets;
  std::string device;
  bool no_device = false;
};

void add_config_command(CLI::App& app, ConfigOptions& options);

// Prints the schema, or checks every file as a run of it would: 1 if one of them could not be run, else 0.
int config_command(const ConfigOptions& options);

}  // namespace qtrace::experiments
