// The long render that errors are measured against: plain path tracing without learned directions, found
// again by a hash of everything that defines it.
#pragma once

#include "engine/core/image.h"
#include "engine/core/settings.h"
#include "engine/gpu/context.h"
#include "experiments/config.h"
#include "experiments/metrics.h"
#include "experiments/progress.h"
#include "experiments/scene_store.h"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace qtrace::experiments {

// Raised whenever the meaning of a reference changes, so that older files are no longer found.
constexpr int kReferenceVersion = 1;

struct ReferenceSpec {
  RenderSettings settings;
  int frames = 0;
  Json definition;   // everything that decides the image, but not the device
  std::string hash;  // of the definition; the file's name

  double work() const;  // pixels times frames
};

// BSDF sampling with one-ray NEE and the default Russian roulette, so that runs which differ in those
// share one reference; size, bounces and environment are the run's, the choice of lights is the reference's
// own.
ReferenceSpec reference_spec(const RunConfig& config, const std::string& scene_hash);

struct Reference {
  ReferenceSpec spec;
  std::string scene;           // name
  std::filesystem::path file;  // where it was found or kept
  std::string origin;          // "rendered", "found" or "shipped"
  RadianceImage image;
  ReferenceNoise noise;
  std::uint64_t non_finite = 0;  // samples that were not finite and count as 0 in it
};

// Looks in the results first, then among the references that are shipped beside a config.
class ReferenceStore {
 public:
  ReferenceStore(const gpu::Context& context, std::filesystem::path results_root, Progress& progress);

  // Whether get() will find a file rather than render; the file may still turn out to be unusable.
  static bool exists(const ReferenceSpec& spec, const std::filesystem::path& results_root,
                     const std::filesystem::path& config_folder);

  // Finds or renders. An unusable file (truncated, other size, other hash, not finite) is named in a warning
  // and rendered anew into the results. Always reads the kept file, so that found and rendered references
  // are the same bits. Throws Error; a failure is remembered, and not tried again for later runs.
  std::shared_ptr<const Reference> get(const ReferenceSpec& spec, const LoadedScene& scene,
                                       const std::filesystem::path& config_folder);

  // One of each that get() returned, without its image.
  const std::map<std::string, Reference>& used() const { return used_; }

 private:
  Reference find_or_render(const ReferenceSpec& spec, const LoadedScene& scene,
                           const std::filesystem::path& config_folder);
  void render(const ReferenceSpec& spec, const LoadedScene& scene, const std::filesystem::path& file);

  const gpu::Context& context_;
  std::filesystem::path results_root_;
  Progress& progress_;
  std::shared_ptr<const Reference> last_;  // runs of one scene follow each other
  std::map<std::string, Reference> used_;
  std::map<std::string, std::string> failures_;
};

// What a reference file holds.
struct StoredReference {
  RadianceImage image;
  std::uint64_t non_finite = 0;  // as in Reference
};

// Reads a reference file. Throws Error that says why it cannot serve.
StoredReference read_reference(const std::filesystem::path& file, const ReferenceSpec& spec);

}  // namespace qtrace::experiments
