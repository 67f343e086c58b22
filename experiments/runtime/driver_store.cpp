#include "experiments/runtime/driver_store.h"

#include "engine/core/check.h"
#include "engine/device_scene/driver_measurement.h"
#include "experiments/files/atomic_file.h"
#include "experiments/files/hash.h"
#include "experiments/runtime/manifest.h"
#include "experiments/runtime/version.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <sstream>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::optional<std::string> forced() {
  std::string text = environment("QTRACE_DRIVER");
  if (text.empty()) return std::nullopt;
  return text;
}

// Empty where the user has no folder for such files.
fs::path cache_file(const gpu::DeviceInfo& device) {
  const std::string given = environment("XDG_CACHE_HOME");
  const std::string home = environment("HOME");
  if (given.empty() && home.empty()) return {};
  const fs::path folder = (given.empty() ? fs::path(home) / ".cache" : fs::path(given)) / "qtrace";
  const unsigned threads = gpu::usual_choices().work_threads;
  const std::string driver =
      fmt::format("{}\n{}\n{}\n{}", device.renderer, device.vendor, device.gl_version, threads);
  return folder / fmt::format("driver-{}.json", hash_text(driver));
}

// Where a manifest's device is the context's own.
std::optional<gpu::DriverChoices> choices_in(const Json& device, const gpu::DeviceInfo& own) {
  try {
    if (device.at("renderer") != own.renderer || device.at("gl_version") != own.gl_version)
      return std::nullopt;
    const auto fetch = gpu::fetch_named(device.at("buffer_fetch").get<std::string>());
    const auto stack = gpu::stack_named(device.at("traversal_stack").get<std::string>());
    const auto threads = device.at("work_threads").get<unsigned>();
    if (!fetch || !stack || !gpu::offers(*fetch)) return std::nullopt;
    // Any number gives the right images, but another machine's would hide that this is another machine.
    if (threads != 1 && threads != gpu::usual_choices().work_threads) return std::nullopt;
    return gpu::DriverChoices{*fetch, *stack, threads};
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

std::optional<gpu::DriverChoices> choices_of(const fs::path& file, const gpu::DeviceInfo& own,
                                             bool of_this_program) {
  try {
    const Json json = read_json_file(file);
    if (of_this_program && json.at("binary") != binary_hash()) return std::nullopt;
    return choices_in(json.at("device"), own);
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

std::string text_of(const gpu::DriverChoices& choices) {
  return fmt::format("buffers by {}, stack in {}, {} part{} of a dispatch", gpu::fetch_name(choices.fetch),
                     gpu::stack_name(choices.stack), choices.work_threads,
                     choices.work_threads == 1 ? "" : "s");
}

Json measurement_json(const gpu::DeviceInfo& device, const gpu::DriverMeasurement& measurement) {
  Json ways = Json::array();
  for (const gpu::MeasuredWay& way : measurement.ways) {
    ways.push_back({{"buffer_fetch", gpu::fetch_name(way.choices.fetch)},
                    {"traversal_stack", gpu::stack_name(way.choices.stack)},
                    {"milliseconds", way.milliseconds}});
  }
  return {{"binary", binary_hash()},
          {"measured", utc_now()},
          {"device", device_json(device)},
          {"ways", std::move(ways)}};
}

// Creates the file unless there is one: of several processes that try, one succeeds.
void create_once(const fs::path& file, const std::string& content) {
  if (fs::exists(file)) return;
  make_folder(file.parent_path());
  const fs::path own = file.string() + fmt::format(".{}-{}", host_name(), ::getpid());
  write_bytes(own, content);
  std::error_code error;
  fs::create_hard_link(own, file, error);                        // fails where the file is there
  if (error && !fs::exists(file)) fs::rename(own, file, error);  // a file system without such links
  fs::remove(own, error);
}

}  // namespace

gpu::DriverChoices parse_choices(const std::string& text, const gpu::DriverChoices& others) {
  gpu::DriverChoices choices = others;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const std::size_t equals = std::min(part.find('='), part.size());
    const std::string name = part.substr(0, equals);
    const std::string value = part.substr(std::min(equals + 1, part.size()));
    bool good = false;
    if (name == "fetch") {
      if (const auto fetch = gpu::fetch_named(value)) choices.fetch = *fetch, good = true;
    } else if (name == "stack") {
      if (const auto stack = gpu::stack_named(value)) choices.stack = *stack, good = true;
    } else if (name == "work_threads") {
      const auto [end, error] =
          std::from_chars(value.data(), value.data() + value.size(), choices.work_threads);
      good = error == std::errc() && end == value.data() + value.size() && choices.work_threads >= 1;
    }
    check(good,
          "QTRACE_DRIVER '{}': '{}' is none of fetch=texture|image|storage, stack=memory|registers and "
          "work_threads=NUMBER",
          text, part);
  }
  return choices;
}

void choose_driver(gpu::Context& context, Progress& progress) {
  if (const auto text = forced()) {
    context.use(parse_choices(*text, gpu::usual_choices()));
    return;
  }
  const fs::path file = cache_file(context.device());
  if (const auto kept = choices_of(file, context.device(), true)) {
    context.use(*kept);
    return;
  }
  const gpu::DriverMeasurement measurement = gpu::measure_driver(context);
  context.use(measurement.best);
  progress.note("measured what suits this driver: " + text_of(measurement.best));
  if (file.empty()) return;
  try {
    make_folder(file.parent_path());
    write_file(file, json_text(measurement_json(context.device(), measurement)));
  } catch (const Error&) {
    // The next process measures again.
  }
}

void keep_choices(gpu::Context& context, const Json& device) {
  if (forced()) return;
  if (const auto choices = choices_in(device, context.device())) context.use(*choices);
}

void keep_choices_of(gpu::Context& context, const fs::path& results, bool is_shard) {
  if (forced()) return;
  const fs::path manifest = results / "manifest.json";
  const fs::path agreed = results / ".driver.json";
  if (is_shard && !fs::exists(manifest)) {
    create_once(agreed, json_text(Json{{"device", device_json(context.device())}}));
  }
  for (const fs::path& file : {manifest, agreed}) {
    if (const auto choices = choices_of(file, context.device(), false)) {
      context.use(*choices);
      return;
    }
  }
}

}  // namespace qtrace::experiments
