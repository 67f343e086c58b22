#include "experiments/reference/reference.h"

#include "engine/core/check.h"
#include "experiments/files/hash.h"
#include "experiments/images/exr.h"
#include "experiments/images/exr_images.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

// Frames from look to look at the noise: a look costs about as much as reading the film back, a small part of
// so many frames, and no more than these are rendered in vain.
constexpr int kFramesPerLook = 16;
// Of a reference with Sobol' points: its sequences, and after how many scattering events roulette begins.
// Relative error is that of dark pixels, where roulette costs more than it saves: begun after 3 events, it
// makes the time to the same relMSE 0.74 (open_sky), 0.77 (many_lights), 0.94 (cornell_box), 1.35 (simple),
// 1.67 (occluded, glossy_room) and 1.78 times (door_ajar) as long.
constexpr int kReferenceReplicates = 16;
constexpr int kRouletteStart = 8;

int round_up(int frames, int step) { return (frames + step - 1) / step * step; }

// Sobol' points are worth looking at when their number is a power of two, or half as many again.
int next_net(int frame, int replicates) {
  int points = 1;
  while (points * replicates < frame)
    points = std::has_single_bit(static_cast<unsigned>(points)) && points > 1
                 ? points + points / 2
                 : static_cast<int>(std::bit_ceil(static_cast<unsigned>(points) + 1));
  return points * replicates;
}

bool all_finite(const std::vector<glm::dvec3>& pixels) {
  for (const glm::dvec3& p : pixels) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return false;
  }
  return true;
}

// Kept with the image, so that a reference found later does not hide them.
std::uint64_t count_non_finite(const ExrImage& exr) {
  const auto found = exr.metadata.find(kReferenceNonFinite);
  return found == exr.metadata.end() ? 0 : std::stoull(found->second);
}

}  // namespace

bool ReferenceWish::met(std::uint64_t samples, const ReferenceNoise& noise) const {
  return samples >= static_cast<std::uint64_t>(frames) &&
         (relative_error == 0 || noise.relative_error() <= relative_error);
}

bool ReferenceWish::settled(std::uint64_t samples, const ReferenceNoise& noise) const {
  const auto longest = static_cast<std::uint64_t>(std::max(frames, max_frames));
  return met(samples, noise) || (relative_error > 0 && samples >= longest);
}

int ReferenceWish::next_look(int frame) const {
  if (frame <= frames) return frames;
  if (relative_error == 0) return frame;
  const int look = replicates > 1 ? next_net(frame, replicates) : round_up(frame, kFramesPerLook);
  return std::max(frame, std::min(look, max_frames));
}

ReferenceWish ReferenceWish::joined(const ReferenceWish& other) const {
  ReferenceWish both = *this;
  both.frames = std::max(frames, other.frames);
  if (other.relative_error == 0) return both;
  const bool alone = relative_error == 0;
  both.relative_error = alone ? other.relative_error : std::min(relative_error, other.relative_error);
  both.max_frames = alone ? other.max_frames : std::max(max_frames, other.max_frames);
  return both;
}

std::string ReferenceWish::text() const {
  if (relative_error == 0) return fmt::format("{} frames", frames);
  return fmt::format("relative error {:g} in {} to {} frames", relative_error, frames, max_frames);
}

ReferenceSpec reference_spec(const RunConfig& config, const std::string& scene_hash) {
  ReferenceSpec spec;
  spec.settings.width = config.render.width;
  spec.settings.height = config.render.height;
  spec.settings.max_bounces = config.render.max_bounces;
  spec.settings.environment = config.render.environment;
  spec.settings.seed = config.reference.seed;
  spec.settings.sampler = Sampler::bsdf;
  spec.settings.random = config.reference.random;
  if (spec.settings.random == RandomNumbers::sobol) {
    spec.settings.replicates = kReferenceReplicates;
    spec.settings.russian_roulette_start = kRouletteStart;
  }
  spec.settings.nee = config.reference.nee;
  spec.settings.lights = config.reference.lights;
  const int replicates = spec.settings.replicates;
  spec.wish = {round_up(config.reference.frames, replicates), config.reference.relative_error,
               round_up(config.reference.max_frames, replicates), replicates};
  spec.definition = write_knobs(spec.settings, Written::identity);
  if (!has_table(spec.settings)) spec.definition.erase("rl");  // plays no part
  spec.definition["scene"] = scene_hash;
  spec.definition["reference_version"] = kReferenceVersion;
  spec.hash = hash_text(canonical_text(spec.definition));
  return spec;
}

Json reference_json(const Reference& reference) {
  return {{"hash", reference.spec.hash},
          {"file", reference.file.string()},
          {"origin", reference.origin},
          {"definition", reference.spec.definition},
          {"samples", reference.samples},
          {"wish", reference.spec.wish.text()},
          {"meets_wish", reference.meets_wish()},
          {"reference_mse", reference.noise.mse},
          {"reference_relmse", reference.noise.relmse},
          {"reference_relative_error", reference.noise.relative_error()}};
}

std::string noise_warning(const Reference& reference) {
  if (reference.meets_wish()) return "";
  return fmt::format(
      "the reference {} has a relative error of {:.3g} after {} frames where {:g} was wished: "
      "reference.max_frames ended it; raise that",
      reference.spec.hash, reference.noise.relative_error(), reference.samples,
      reference.spec.wish.relative_error);
}

StoredReference read_reference(const fs::path& file, const ReferenceSpec& spec) {
  const ExrImage exr = read_exr(file);
  const RadianceImage image = to_radiance(exr, file);
  const auto hash = exr.metadata.find(kReferenceHash);
  check(hash != exr.metadata.end() && hash->second == spec.hash, "{}: is not the reference {}", file.string(),
        spec.hash);
  check(image.width == spec.settings.width && image.height == spec.settings.height,
        "{}: has {}x{} pixels but must have {}x{}", file.string(), image.width, image.height,
        spec.settings.width, spec.settings.height);
  check(image.samples >= 2, "{}: has {} samples per pixel but must have 2 at least", file.string(),
        image.samples);
  check(all_finite(image.mean) && all_finite(image.variance), "{}: has pixels that are not finite",
        file.string());
  return {image, count_non_finite(exr)};
}

}  // namespace qtrace::experiments
