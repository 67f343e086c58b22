#include "experiments/config/config.h"

#include "engine/core/check.h"

#include <algorithm>
#include <bit>

namespace qtrace::experiments {
namespace {

constexpr std::size_t kMaxName = 100;  // bytes

void check_name(const std::string& name) {
  check(!name.empty(), "key 'name' is missing; it names the experiment's folder under the results");
  const bool plain = name.size() <= kMaxName && name.front() != '.' && name.front() != '-' &&
                     std::all_of(name.begin(), name.end(), [](char c) {
                       return static_cast<unsigned char>(c) >= 32 && c != '/' && c != '\\' && c != 127;
                     });
  check(plain,
        "key 'name' is {} but must be a plain file name: at most {} bytes, no '/' or '\\', and no '.' or "
        "'-' in front",
        show(name), kMaxName);
  check(name != "references",
        "key 'name' is \"references\", where reference images are kept; choose another");
}

// Of a snapshot in the list.
KnobInfo one_frame(const KnobInfo& info) { return {info.name, info.unit, info.help, 1, 1e6}; }

void check_snapshots(const RunConfig& config) {
  if (config.snapshots.powers_of_two) return;
  int previous = 0;
  for (const int frame : config.snapshots.frames) {
    check(frame <= config.frames, "key 'snapshots' holds frame {}, but the run has only {} frames", frame,
          config.frames);
    check(frame > previous, "key 'snapshots' must be increasing, but frame {} follows frame {}", frame,
          previous);
    previous = frame;
  }
}

}  // namespace

std::vector<int> SnapshotPlan::resolve(int last_frame) const {
  std::vector<int> resolved = frames;
  if (powers_of_two) {
    resolved.clear();
    const int powers = static_cast<int>(std::bit_width(static_cast<unsigned>(last_frame)));
    for (int exponent = 0; exponent < powers; ++exponent) resolved.push_back(1 << exponent);
  }
  if (resolved.empty() || resolved.back() != last_frame) resolved.push_back(last_frame);
  return resolved;
}

std::string KnobType<SnapshotPlan>::describe(const KnobInfo&) {
  return "\"powers_of_two\" or a list of frames";
}

void KnobType<SnapshotPlan>::read(const Json& json, const KnobInfo& info, const std::string& path,
                                  SnapshotPlan& plan) {
  plan = SnapshotPlan{};
  if (json == "powers_of_two") return;
  if (!json.is_array()) reject_value(path, json, describe(info));
  plan.powers_of_two = false;
  const KnobInfo frame_info = one_frame(info);
  for (std::size_t i = 0; i < json.size(); ++i) {
    int frame = 0;
    KnobType<int>::read(json[i], frame_info, fmt::format("{}[{}]", path, i), frame);
    plan.frames.push_back(frame);
  }
}

Json KnobType<SnapshotPlan>::schema(const KnobInfo& info) {
  const Json frames{{"type", "array"}, {"items", KnobType<int>::schema(one_frame(info))}};
  return {{"anyOf", {{{"const", "powers_of_two"}}, frames}}};
}

Json KnobType<SnapshotPlan>::write(const SnapshotPlan& plan) {
  if (plan.powers_of_two) return "powers_of_two";
  Json frames = Json::array();
  for (const int frame : plan.frames) frames.push_back(frame);
  return frames;
}

namespace {

// Replicates whose spread is a variance that a verdict can rest on.
constexpr int kFewestReplicates = 8;

void check_random_numbers(const RenderSettings& render, const Expectation& expect) {
  check(render.replicates == 1 || render.replicates % 2 == 0,
        "key 'replicates' is {} but must be 1 or even: odd and even frames belong to different ones",
        render.replicates);
  check(render.rl.trial_frames % 2 == 0,
        "key 'rl.trial_frames' is {} but must be even: the trial compares frames with the table and without "
        "it, two "
        "groups of each",
        render.rl.trial_frames);
  check(
      render.light_path_trial % 2 == 0,
      "key 'light_path_trial' is {} but must be even: the trial compares frames with light paths and without "
      "them, two groups of each",
      render.light_path_trial);
  check(expect.against == Against::nothing || render.random == RandomNumbers::independent ||
            render.replicates >= kFewestReplicates,
        "key 'expect' judges a run by the variance of its samples, and with 'random' sobol only replicates "
        "have one: "
        "'replicates' is {} and must be {} at least",
        render.replicates, kFewestReplicates);
}

}  // namespace

View view_of(const RunConfig& config) {
  return {config.gltf_scene, config.camera,
          static_cast<double>(config.render.width) / static_cast<double>(config.render.height)};
}

std::string variance_note(const RenderSettings& settings) {
  if (settings.random == RandomNumbers::independent) return "of the mean, from the samples of the pixel";
  if (settings.replicates > 1)
    return fmt::format(
        "of the mean, from the spread of {} replicates, each a sequence of Sobol' points of its own",
        settings.replicates);
  return "as if samples were independent; Sobol' points are not, so it gives no interval: as a rule it is "
         "far too large, "
         "and only other seeds show the error";
}

void check_run_config(const RunConfig& config) {
  check_name(config.name);
  check(!config.scene.empty(), "key 'scene' is missing; it names a .gltf or .glb file");
  check(config.warmup_frames < config.frames,
        "key 'warmup_frames' is {} but must be less than 'frames', which is {}: a median needs a frame",
        config.warmup_frames, config.frames);
  check(config.render.seed != config.reference.seed,
        "keys 'seed' and 'reference.seed' are both {}: with the same random numbers the reference's noise "
        "would hide the run's error; choose another 'reference.seed'",
        config.render.seed);
  check(
      config.reference.relative_error == 0 || config.reference.frames <= config.reference.max_frames,
      "key 'reference.frames' is {} but must be at most 'reference.max_frames', which is {}: it is the least "
      "length of a reference with a 'relative_error'",
      config.reference.frames, config.reference.max_frames);
  check_random_numbers(config.render, config.expect);
  check_snapshots(config);
}

}  // namespace qtrace::experiments
