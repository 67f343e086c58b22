// Everything that one run can be told: the tracer's settings and what is measured of them.
#pragma once

#include "engine/core/filter_settings.h"
#include "engine/core/settings.h"
#include "engine/scene/view.h"
#include "experiments/config/environment_knob.h"
#include "experiments/config/json_knobs.h"
#include "experiments/config/view_knobs.h"
#include "experiments/measure/expectation.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace qtrace::experiments {

// After which frames an image is kept and its errors are computed; the last frame always belongs to them.
struct SnapshotPlan {
  bool powers_of_two = true;
  std::vector<int> frames;  // unless powers_of_two; 1-based, increasing

  std::vector<int> resolve(int last_frame) const;
};

template <>
struct KnobType<SnapshotPlan> {
  static std::string describe(const KnobInfo&);
  static void read(const Json& json, const KnobInfo& info, const std::string& path, SnapshotPlan& plan);
  static Json write(const SnapshotPlan& plan);
  static Json schema(const KnobInfo& info);
};

// Next event estimation with one ray to a light by power has the lowest variance per sample, or nearly, of
// what does not learn: relMSE of one sample at 96 x 96, 5 bounces (from 64, two seeds, without the
// reference's noise):
//                none   one_ray, uniform   one_ray, power   two_ray, power
//   simple        27.9         0.345            0.345            0.345
//   occluded      46.2         3.21             3.21             2.95
//   cornell_box   19.7         0.195            0.195            0.195
//   many_lights  351          12.7             15.6             15.9
//   furnace        0.0377      0.0333           0.0333           0.128
// It stays fixed, as a choice by a pilot would make the hash depend on a rendering; nee and lights change it.
struct ReferenceSettings {
  int frames = 1024;
  RandomNumbers random = RandomNumbers::sobol;
  double relative_error = 0;
  int max_frames = 16384;
  std::uint32_t seed = 9001;
  Nee nee = Nee::one_ray;
  LightChoice lights = LightChoice::power;
  std::string scene;
};

template <class Visitor>
void visit_knobs(Visitor& visit, ReferenceSettings& reference) {
  // Two frames at least: one sample has no variance, so that the reference's noise would be unknown.
  visit(KnobInfo{"frames", "samples per pixel",
                 "least length of the render that errors are measured against; a longer one that is there "
                 "serves as it is, a shorter one is extended",
                 2, 1e7},
        reference.frames);
  visit(KnobInfo{"relative_error", "",
                 "noise that the reference may have itself, sqrt(reference_relmse): after 'frames' it is "
                 "extended until it has no more; 0: whatever it has then",
                 0, 1},
        reference.relative_error);
  visit(
      KnobInfo{"max_frames", "samples per pixel", "where 'relative_error' gives up, with a warning", 2, 1e7},
      reference.max_frames);
  visit(KnobInfo{.name = "random",
                 .unit = "",
                 .help = "its random numbers; with sobol it is made of 16 sequences of points, whose spread "
                         "is its noise",
                 .implied = "\"independent\""},
        reference.random);
  visit(KnobInfo{"seed", "", "its seed; must differ from the seeds of the runs", 0,
                 std::numeric_limits<std::uint32_t>::max()},
        reference.seed);
  visit(KnobInfo{"nee", "", "its next event estimation"}, reference.nee);
  visit(KnobInfo{"lights", "",
                 "how its next event estimation picks a light; learned: with the default table, said in "
                 "every table"},
        reference.lights);
  visit(KnobInfo{"scene", "path",
                 "glTF file that the reference shows, where that must look the same as the run's own scene; "
                 "empty: the run's own"},
        reference.scene);
}

// When the learned table is written into the run's folder (saved_table.h).
enum class SaveTable { none, last, snapshots };

}  // namespace qtrace::experiments

template <>
struct qtrace::EnumNames<qtrace::experiments::SaveTable> {
  static constexpr std::array<std::string_view, 3> values{"none", "last", "snapshots"};
};

namespace qtrace::experiments {

struct RunConfig {
  std::string name;
  std::string scene;
  NameOrIndex gltf_scene;
  CameraChoice camera;
  RenderSettings render;
  std::optional<EnvironmentImage> environment_image;  // in place of render.environment, which is black then
  int frames = 64;
  int warmup_frames = 1;
  SnapshotPlan snapshots;
  SaveTable save_table = SaveTable::none;
  ReferenceSettings reference;
  bool flip = false;
  double firefly_multiple = 100;
  FilterSettings filter;
  Expectation expect;
  double checkpoint_s = 60;
  double frame_timeout_s = 600;
};

template <class Visitor>
void visit_knobs(Visitor& visit, RunConfig& config) {
  visit(KnobInfo{"name", "", "the experiment's name: its folder under the results"}, config.name);
  visit(KnobInfo{"scene", "path", "glTF file (.gltf or .glb), relative to the config file"}, config.scene);
  visit(KnobInfo{.name = "gltf_scene",
                 .unit = "",
                 .help = "which scene of the file, where it has several; empty: its default",
                 .implied = "\"\""},
        config.gltf_scene);
  visit(
      KnobInfo{
          .name = "camera",
          .unit = "",
          .help =
              "what is seen: through a camera of the file (empty: its first), from a place (fov: vertical), "
              "or fit: everything, from the front and a little above",
          .implied = "\"\""},
      config.camera);
  EnvironmentKnob environment{config.render.environment, config.environment_image};
  visit_knobs(visit, config.render, environment);
  visit(KnobInfo{"frames", "frames", "length of the run; a frame is one sample per pixel", 1, 1e6},
        config.frames);
  visit(KnobInfo{"warmup_frames", "frames",
                 "first frames that the median time leaves out; they stay in all totals", 0, 1e6},
        config.warmup_frames);
  visit(KnobInfo{"snapshots", "frames", "frames after which image and errors are kept, besides the last"},
        config.snapshots);
  visit(KnobInfo{"save_table", "",
                 "keep the table as .npy files: never, after the last frame, or at snapshots"},
        config.save_table);
  visit(KnobInfo{"reference", "",
                 "the long render without learned directions that errors are measured against"},
        config.reference);
  visit(
      KnobInfo{
          "flip", "",
          "measure HDR-FLIP at snapshots, too: what an observer sees; costs like one frame or two each time"},
      config.flip);
  visit(
      KnobInfo{
          "firefly_multiple", "",
          "a sample brighter than this many times its pixel's reference (at least 1 % of the mean of the "
          "reference image) counts as a firefly",
          1, 1e9},
      config.firefly_multiple);
  visit(KnobInfo{"filter", "", "an edge-avoiding filter of the snapshots, measured on its own: it is biased"},
        config.filter);
  visit(KnobInfo{"expect", "", "what the run is judged by: a verdict in summary.csv, table and exit code"},
        config.expect);
  visit(KnobInfo{"checkpoint_s", "s",
                 "a run's state is kept this often, so that no more than this is lost when it is killed",
                 0.001, 86400},
        config.checkpoint_s);
  visit(KnobInfo{"frame_timeout_s", "s", "a run fails when one of its frames takes longer", 0.001, 86400},
        config.frame_timeout_s);
}

// The keys that change neither a pixel nor what is measured: results that differ in them alone are the same.
inline constexpr std::array<std::string_view, 2> kKeysOfExecution{"checkpoint_s", "frame_timeout_s"};

// What a run shows of its scene's file, and its reference of its own.
View view_of(const RunConfig& config);

// What the variance beside an image's mean is: files and manifests say it.
std::string variance_note(const RenderSettings& settings);

// Throws Error that names the key where values that are each allowed do not fit together.
void check_run_config(const RunConfig& config);

}  // namespace qtrace::experiments
