// Where references are kept: found again, extended, or rendered.
#pragma once

#include "engine/gpu/context.h"
#include "experiments/reference/reference.h"
#include "experiments/runtime/progress.h"
#include "experiments/runtime/scene_store.h"
#include "experiments/runtime/stopper.h"

#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace qtrace::experiments {

// What there is of a reference before it is asked for.
struct ReferenceOutlook {
  bool enough = false;  // a file serves as it is
  int frames = 0;       // of that file, else of the state that rendering goes on from; 0: from the start

  std::string text() const;
};

struct FoundReference;

// Looks in the results first, then among the references that are shipped beside a config; those are never
// written to.
class ReferenceStore {
 public:
  ReferenceStore(const gpu::Context& context, std::filesystem::path results_root, const Stopper& stopper,
                 Progress& progress);

  static ReferenceOutlook outlook(const ReferenceSpec& spec, const std::filesystem::path& results_root,
                                  const std::filesystem::path& config_folder);

  // Finds, extends or renders. An unusable file (truncated, other size, other hash, not finite) is named in a
  // warning and made anew in the results. Always reads the kept file, so that found and rendered references
  // are the same bits. Where another process renders the same reference, that is waited for. Throws Error (a
  // failure is remembered, and not tried again for later runs), Stopped and gpu::ContextLost.
  std::shared_ptr<const Reference> get(const ReferenceSpec& spec, const LoadedScene& scene,
                                       const std::filesystem::path& config_folder);

  // Adds one that is there already to used(); renders nothing.
  void note(const ReferenceSpec& spec, const LoadedScene& scene, const std::filesystem::path& config_folder);

  // One of each that get() returned or note() found, without its image.
  const std::map<std::string, Reference>& used() const { return used_; }

 private:
  Reference find_or_render(const ReferenceSpec& spec, const LoadedScene& scene,
                           const std::filesystem::path& config_folder);

  void remember(const Reference& reference);
  Reference use(const ReferenceSpec& spec, const LoadedScene& scene, FoundReference found);

  const gpu::Context& context_;
  std::filesystem::path results_root_;
  const Stopper& stopper_;
  Progress& progress_;
  std::shared_ptr<const Reference> last_;  // the others are read again when their turn comes
  std::map<std::string, Reference> used_;
  std::map<std::string, std::string> failures_;
};

}  // namespace qtrace::experiments
