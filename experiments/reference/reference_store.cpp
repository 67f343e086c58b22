#include "experiments/reference/reference_store.h"

#include "engine/core/check.h"
#include "experiments/files/atomic_file.h"
#include "experiments/files/folder_lock.h"
#include "experiments/reference/reference_render.h"

#include <algorithm>
#include <functional>
#include <optional>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

using Complaint = std::function<void(const Error&)>;

}  // namespace

struct FoundReference {
  fs::path file;
  std::string origin;
  StoredReference stored;

  bool serves(const ReferenceWish& wish) const {
    return wish.settled(stored.image.samples, *reference_noise(stored.image));
  }
};

namespace {

using Found = FoundReference;

fs::path kept_file(const fs::path& results_root, const std::string& hash) {
  return results_root / "references" / (hash + ".exr");
}

fs::path shipped_file(const fs::path& config_folder, const std::string& hash) {
  return config_folder / "references" / (hash + ".exr");
}

std::optional<Found> read_if_there(const fs::path& file, const std::string& origin, const ReferenceSpec& spec,
                                   const Complaint& complain) {
  if (!fs::exists(file)) return std::nullopt;
  try {
    return Found{file, origin, read_reference(file, spec)};
  } catch (const Error& error) {
    complain(error);
    return std::nullopt;
  }
}

// The first file that serves. `frames`: how long the results' own is, at least what it will then become.
std::optional<Found> find(const ReferenceSpec& spec, const fs::path& results_root,
                          const fs::path& config_folder, const Complaint& complain, int& frames) {
  auto kept = read_if_there(kept_file(results_root, spec.hash), "found", spec, complain);
  if (kept && kept->serves(spec.wish)) return kept;
  frames = kept ? static_cast<int>(kept->stored.image.samples) : 0;
  auto shipped = read_if_there(shipped_file(config_folder, spec.hash), "shipped", spec, complain);
  if (shipped && shipped->serves(spec.wish)) return shipped;
  return std::nullopt;
}

}  // namespace

std::string ReferenceOutlook::text() const {
  if (enough) return fmt::format("found with {} frames", frames);
  if (frames > 0) return fmt::format("to be extended from {} frames", frames);
  return "to be rendered";
}

ReferenceStore::ReferenceStore(const gpu::Context& context, fs::path results_root, const Stopper& stopper,
                               Progress& progress)
    : context_(context), results_root_(std::move(results_root)), stopper_(stopper), progress_(progress) {}

ReferenceOutlook ReferenceStore::outlook(const ReferenceSpec& spec, const fs::path& results_root,
                                         const fs::path& config_folder) {
  int frames = 0;
  const auto found = find(
      spec, results_root, config_folder, [](const Error&) {}, frames);
  if (found) return {true, static_cast<int>(found->stored.image.samples)};
  const auto state = read_reference_state(kept_file(results_root, spec.hash), spec, [](const Error&) {});
  return {false, state ? static_cast<int>(state->state.frames) : 0};
}

std::shared_ptr<const Reference> ReferenceStore::get(const ReferenceSpec& spec, const LoadedScene& scene,
                                                     const fs::path& config_folder) {
  if (last_ && last_->spec.hash == spec.hash && spec.wish.settled(last_->samples, last_->noise)) return last_;
  const auto failure = failures_.find(spec.hash);
  check(failure == failures_.end(), "the reference failed before: {}",
        failure == failures_.end() ? "" : failure->second);
  last_.reset();  // before the next one takes its memory
  try {
    last_ = std::make_shared<const Reference>(find_or_render(spec, scene, config_folder));
  } catch (const gpu::ContextLost&) {
    throw;
  } catch (const DiskFull& error) {
    throw Stopped{error.what(), 1};
  } catch (const std::exception& error) {
    failures_[spec.hash] = error.what();
    throw;
  }
  remember(*last_);
  return last_;
}

void ReferenceStore::note(const ReferenceSpec& spec, const LoadedScene& scene,
                          const fs::path& config_folder) {
  if (used_.contains(spec.hash)) return;
  int frames = 0;
  auto found = find(
      spec, results_root_, config_folder, [](const Error&) {}, frames);
  if (found) remember(use(spec, scene, std::move(*found)));
}

void ReferenceStore::remember(const Reference& reference) {
  Reference summary = reference;
  summary.image = RadianceImage{};
  used_.insert_or_assign(reference.spec.hash, std::move(summary));
}

Reference ReferenceStore::find_or_render(const ReferenceSpec& spec, const LoadedScene& scene,
                                         const fs::path& config_folder) {
  const auto complain = [this](const Error& error) {
    progress_.warning(fmt::format("this reference cannot be used and is rendered anew: {}", error.what()));
  };
  int frames = 0;
  auto found = find(spec, results_root_, config_folder, complain, frames);
  if (found) return use(spec, scene, std::move(*found));
  const fs::path file = kept_file(results_root_, spec.hash);
  make_folder(file.parent_path());
  const auto lock =
      FolderLock::wait(file.parent_path() / fmt::format(".{}.lock", spec.hash), [this] { stopper_.check(); });
  // Another process may have rendered it in the meantime.
  found = find(
      spec, results_root_, config_folder, [](const Error&) {}, frames);
  if (!found) {
    ReferenceSpec longer = spec;  // never replaced by a shorter one
    longer.wish.frames = std::max(spec.wish.frames, frames);
    const bool extended = render_reference(context_, longer, scene, file, stopper_, progress_);
    found = Found{file, extended ? "extended" : "rendered", read_reference(file, spec)};
  }
  return use(spec, scene, std::move(*found));
}

Reference ReferenceStore::use(const ReferenceSpec& spec, const LoadedScene& scene, FoundReference found) {
  Reference reference;
  reference.spec = spec;
  reference.scene = scene.scene.name;
  reference.file = found.file;
  reference.origin = found.origin;
  reference.image = std::move(found.stored.image);
  reference.samples = reference.image.samples;
  reference.noise = *reference_noise(reference.image);
  reference.non_finite = found.stored.non_finite;
  if (used_.contains(spec.hash)) return reference;  // warned of before
  if (reference.non_finite > 0) {
    progress_.warning(fmt::format("{}: {} samples of this reference were not finite and count as 0 in it",
                                  reference.file.string(), reference.non_finite));
  }
  if (const std::string warning = noise_warning(reference); !warning.empty()) progress_.warning(warning);
  return reference;
}

}  // namespace qtrace::experiments
