#include "experiments/commands/gltf.h"

#include "engine/gltf_document/support.h"
#include "experiments/files/text_table.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>

namespace qtrace::experiments {
namespace {

// `markdown`: the page docs/gltf.md.
int print_support(bool markdown) {
  const std::vector<std::string> header{"property or extension", "what becomes of it", "note"};
  std::vector<std::vector<std::string>> rows;
  for (const gltf::Support& row : gltf::kSupport) {
    rows.push_back(
        {std::string(row.name), std::string(treatment_name(row.treatment)), std::string(row.note)});
  }
  if (!markdown) {
    fmt::print("{}", plain_table(header, rows));
    return 0;
  }
  fmt::print(
      "# What is read of a glTF file\n\nMade by `qtrace gltf --markdown`, from the table by which the reader "
      "itself judges. Warnings name the mesh, the material or the node.\n\n{}",
      markdown_table(header, rows, header.size()));
  return 0;
}

}  // namespace

void add_gltf_command(CLI::App& app, Action& action) {
  CLI::App* gltf = app.add_subcommand("gltf", "List what is read of glTF files");
  const auto markdown = std::make_shared<bool>(false);
  gltf->add_flag("--markdown", *markdown, "as a page of documentation");
  gltf->callback([&action, markdown] { action = [markdown] { return print_support(*markdown); }; });
}

}  // namespace qtrace::experiments
