#include "experiments/reference.h"

#include "engine/core/check.h"
#include "engine/tracer/tracer.h"
#include "experiments/atomic_file.h"
#include "experiments/exr.h"
#include "experiments/hash.h"
#include "experiments/manifest.h"
#include "experiments/version.h"

#include <cmath>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

fs::path kept_file(const fs::path& results_root, const std::string& hash) {
  return results_root / "references" / (hash + ".exr");
}

fs::path shipped_file(const fs::path& config_folder, const std::string& hash) {
  return config_folder / "references" / (hash + ".exr");
}

bool all_finite(const std::vector<glm::dvec3>& pixels) {
  for (const glm::dvec3& p : pixels) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return false;
  }
  return true;
}

constexpr const char* kNonFinite = "nonFinite";  // EXR attribute

// Kept with the image, so that a reference found later does not hide them.
std::uint64_t count_non_finite(const ExrImage& exr) {
  const auto found = exr.metadata.find(kNonFinite);
  return found == exr.metadata.end() ? 0 : std::stoull(found->second);
}

Json sidecar(const ReferenceSpec& spec, const LoadedScene& scene, const RadianceImage& image, double seconds,
             const gpu::DeviceInfo& device) {
  const auto noise = reference_noise(image).value_or(ReferenceNoise{});
  return {{"hash", spec.hash},          {"definition", spec.definition},    {"scene", scene.scene.name},
          {"reference_mse", noise.mse}, {"reference_relmse", noise.relmse}, {"render_s", seconds},
          {"ended", utc_now()},         {"device", device_json(device)},    {"software", software()}};
}

}  // namespace

double ReferenceSpec::work() const { return static_cast<double>(settings.width) * settings.height * frames; }

ReferenceSpec reference_spec(const RunConfig& config, const std::string& scene_hash) {
  ReferenceSpec spec;
  spec.settings.width = config.render.width;
  spec.settings.height = config.render.height;
  spec.settings.max_bounces = config.render.max_bounces;
  spec.settings.environment = config.render.environment;
  spec.settings.seed = config.reference.seed;
  spec.settings.sampler = Sampler::bsdf;
  spec.settings.nee = Nee::one_ray;
  spec.settings.lights = config.reference.lights;
  spec.frames = config.reference.frames;
  spec.definition = write_knobs(spec.settings);
  if (!has_table(spec.settings)) spec.definition.erase("rl");  // plays no part
  spec.definition["frames"] = spec.frames;
  spec.definition["scene"] = scene_hash;
  spec.definition["reference_version"] = kReferenceVersion;
  spec.hash = hash_text(canonical_text(spec.definition));
  return spec;
}

StoredReference read_reference(const fs::path& file, const ReferenceSpec& spec) {
  const ExrImage exr = read_exr(file);
  const RadianceImage image = to_radiance(exr, file);
  const auto hash = exr.metadata.find("referenceHash");
  check(hash != exr.metadata.end() && hash->second == spec.hash, "{}: is not the reference {}", file.string(),
        spec.hash);
  check(image.width == spec.settings.width && image.height == spec.settings.height,
        "{}: has {}x{} pixels but must have {}x{}", file.string(), image.width, image.height,
        spec.settings.width, spec.settings.height);
  check(image.samples == static_cast<std::uint64_t>(spec.frames),
        "{}: has {} samples per pixel but must have {}", file.string(), image.samples, spec.frames);
  check(all_finite(image.mean) && all_finite(image.variance), "{}: has pixels that are not finite",
        file.string());
  return {image, count_non_finite(exr)};
}

ReferenceStore::ReferenceStore(const gpu::Context& context, fs::path results_root, Progress& progress)
    : context_(context), results_root_(std::move(results_root)), progress_(progress) {}

bool ReferenceStore::exists(const ReferenceSpec& spec, const fs::path& results_root,
                            const fs::path& config_folder) {
  return fs::exists(kept_file(results_root, spec.hash)) || fs::exists(shipped_file(config_folder, spec.hash));
}

std::shared_ptr<const Reference> ReferenceStore::get(const ReferenceSpec& spec, const LoadedScene& scene,
                                                     const fs::path& config_folder) {
  if (last_ && last_->spec.hash == spec.hash) return last_;
  const auto failure = failures_.find(spec.hash);
  check(failure == failures_.end(), "the reference failed before: {}",
        failure == failures_.end() ? "" : failure->second);
  last_.reset();  // before the next one takes its memory
  try {
    last_ = std::make_shared<const Reference>(find_or_render(spec, scene, config_folder));
  } catch (const std::exception& error) {
    failures_[spec.hash] = error.what();
    throw;
  }
  Reference summary = *last_;
  summary.image = RadianceImage{};
  used_.emplace(spec.hash, std::move(summary));
  return last_;
}

Reference ReferenceStore::find_or_render(const ReferenceSpec& spec, const LoadedScene& scene,
                                         const fs::path& config_folder) {
  Reference reference{spec, scene.scene.name, kept_file(results_root_, spec.hash), "found", {}, {}};
  const fs::path shipped = shipped_file(config_folder, spec.hash);
  const auto keep = [&](StoredReference stored) {
    reference.image = std::move(stored.image);
    reference.non_finite = stored.non_finite;
  };
  const auto try_file = [&](const fs::path& file, const char* origin) {
    if (!fs::exists(file)) return false;
    try {
      keep(read_reference(file, spec));
    } catch (const Error& error) {
      progress_.warning(fmt::format("this reference cannot be used and is rendered anew: {}", error.what()));
      return false;
    }
    reference.file = file;
    reference.origin = origin;
    return true;
  };
  if (!try_file(reference.file, "found") && !try_file(shipped, "shipped")) {
    render(spec, scene, reference.file);
    keep(read_reference(reference.file, spec));
    reference.origin = "rendered";
  }
  if (reference.non_finite > 0 && !used_.contains(spec.hash)) {
    progress_.warning(fmt::format("{}: {} samples of this reference were not finite and count as 0 in it",
                                  reference.file.string(), reference.non_finite));
  }
  reference.noise = reference_noise(reference.image).value_or(ReferenceNoise{});
  return reference;
}

void ReferenceStore::render(const ReferenceSpec& spec, const LoadedScene& scene, const fs::path& file) {
  make_folder(file.parent_path());
  const auto start = std::chrono::steady_clock::now();
  progress_.begin(fmt::format("reference of {}", scene.scene.name), spec.frames, spec.work() / spec.frames);
  Tracer tracer(context_, scene.scene, spec.settings);
  for (const std::string& warning : tracer.warnings()) {
    progress_.warning(fmt::format("reference {}: {}", spec.hash, warning));
  }
  std::uint64_t non_finite = 0;
  for (int frame = 1; frame <= spec.frames; ++frame) {
    tracer.render_frame();
    context_.finish();
    non_finite += tracer.last_frame_statistics().non_finite;
    progress_.step(frame);
  }
  const RadianceImage image = tracer.radiance();
  for (const NonFiniteSample& sample : tracer.non_finite_samples()) {
    progress_.warning(fmt::format("reference {}: the sample of pixel ({}, {}) in frame {} is not finite",
                                  spec.hash, sample.x, sample.y, sample.frame));
  }
  progress_.end();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_exr(file, to_exr(image, {{"referenceHash", spec.hash},
                                 {kNonFinite, std::to_string(non_finite)},
                                 {"seed", std::to_string(spec.settings.seed)},
                                 {"software", software()}}));
  write_json(fs::path(file).replace_extension(".json"),
             sidecar(spec, scene, image, seconds, context_.device()));
  progress_.note(fmt::format("reference of {}: {} frames rendered in {}, kept as {}", scene.scene.name,
                             spec.frames, duration_text(seconds), file.string()));
}

}  // namespace qtrace::experiments
