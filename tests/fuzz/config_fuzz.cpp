// Feeds bytes to the config reader: the text of a config and, after NUL bytes, values of --set.
#include "engine/core/check.h"
#include "experiments/config/experiment_config.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/json_mutator.h"

#include <algorithm>

namespace qtrace::fuzz {
namespace {

std::vector<std::string> split(std::string_view bytes) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= bytes.size();) {
    const std::size_t end = std::min(bytes.find('\0', begin), bytes.size());
    parts.emplace_back(bytes.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

// As a run's manifest writes it and `inspect` reads it.
void expect_round_trip(const experiments::Run& run) {
  const std::string text = experiments::write_knobs(run.config).dump();
  experiments::RunConfig again;
  experiments::read_knobs(experiments::parse_json(text), again);
  expect(experiments::write_knobs(again).dump() == text, "a run's config must read back the same", text);
  expect(experiments::slug(run.id).size() <= run.id.size(), "a run's id must be a file name", run.id);
}

void read(std::string_view bytes) {
  std::vector<std::string> sets = split(bytes);
  const std::string text = sets.front();
  sets.erase(sets.begin());
  sets.resize(std::min<std::size_t>(sets.size(), 8));  // as many as users type
  // What the sanitizers can read in a second.
  constexpr experiments::SweepLimits kLimits{2000, 1 << 22};
  const experiments::Experiment experiment = experiments::parse_experiment(text, "fuzz.json", sets, kLimits);
  for (const std::string& warning : experiment.warnings) expect_message(warning);
  expect(!experiment.runs.empty(), "an experiment must have a run", text);
  expect_round_trip(experiment.runs.front());
  expect_round_trip(experiment.runs.back());
  (void)experiment.config.dump();
}

}  // namespace
}  // namespace qtrace::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    qtrace::fuzz::read(qtrace::fuzz::as_text(data, size));
  } catch (const qtrace::Error& error) {
    qtrace::fuzz::expect_message(error.what());
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  using namespace qtrace::fuzz;
  const std::string_view bytes = as_text(data, size);
  const std::string_view text = bytes.substr(0, bytes.find('\0'));
  const std::string changed = seed % 2 == 0 ? mutate_json(text, seed / 2) : "";
  const std::string rest(bytes.substr(text.size()));
  return store(changed.empty() ? mutate_bytes(bytes, max_size) : changed + rest, data, max_size);
}
