// The long render that errors are measured against: plain path tracing without learned directions, known
// by a hash of everything that defines it. How long it is does not define it: it can be extended.
#pragma once

#include "engine/core/image.h"
#include "engine/core/settings.h"
#include "experiments/config/config.h"
#include "experiments/measure/metrics.h"

#include <filesystem>
#include <string>

namespace qtrace::experiments {

// Raised whenever the meaning of a reference changes, so that older files are no longer found.
constexpr int kReferenceVersion = 2;

// How good a reference must be: a longer one serves as it is.
struct ReferenceWish {
  int frames = 0;             // at least
  double relative_error = 0;  // of the reference itself, at most; 0: any
  int max_frames = 0;         // where relative_error ends all the same
  int replicates = 1;         // that take turns: it has whole rounds of them

  bool met(std::uint64_t samples, const ReferenceNoise& noise) const;
  // Met, or as long as it may become.
  bool settled(std::uint64_t samples, const ReferenceNoise& noise) const;
  // The first number of frames, not before `frame`, at which relative_error is looked at. The same whatever
  // was interrupted or extended on the way there.
  int next_look(int frame) const;
  // What serves both.
  ReferenceWish joined(const ReferenceWish& other) const;
  std::string text() const;
};

struct ReferenceSpec {
  RenderSettings settings;
  ReferenceWish wish;
  Json definition;   // everything that decides the image, but neither its length nor the device
  std::string hash;  // of the definition; the file's name

  double work_per_frame() const { return static_cast<double>(settings.width) * settings.height; }
};

// BSDF sampling with a roulette of its own, so that runs which differ in those share one reference; size,
// bounces and environment are the run's, next event estimation and its choice of lights are the reference's
// own.
ReferenceSpec reference_spec(const RunConfig& config, const std::string& scene_hash);

struct Reference {
  ReferenceSpec spec;
  std::string scene;           // name
  std::filesystem::path file;  // where it was found or kept
  std::string origin;          // "rendered", "extended", "found" or "shipped"
  RadianceImage image;
  std::uint64_t samples = 0;  // per pixel
  ReferenceNoise noise;
  std::uint64_t non_finite = 0;  // samples that were not finite and count as 0 in it

  bool meets_wish() const { return spec.wish.met(samples, noise); }
};

// For the manifest of a run.
Json reference_json(const Reference& reference);

// Why the reference is noisier than it was wished; empty where it is not.
std::string noise_warning(const Reference& reference);

// What a reference file holds.
struct StoredReference {
  RadianceImage image;
  std::uint64_t non_finite = 0;  // as in Reference
};

// Reads a reference file of any length. Throws Error that says why it cannot serve.
StoredReference read_reference(const std::filesystem::path& file, const ReferenceSpec& spec);

constexpr const char* kReferenceHash = "referenceHash";   // EXR attribute
constexpr const char* kReferenceNonFinite = "nonFinite";  // EXR attribute

}  // namespace qtrace::experiments
