#include "experiments/reference/reference_render.h"

#include "engine/tracer/tracer.h"
#include "experiments/files/atomic_file.h"
#include "experiments/images/exr.h"
#include "experiments/images/exr_images.h"
#include "experiments/runtime/manifest.h"
#include "experiments/runtime/version.h"

#include <algorithm>
#include <chrono>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

// Between two writings of the state, doubled each time: what is lost is at most half of what was done, and
// never much more than a minute; a state of 512 x 512 pixels (33 MB) is written in well below one second.
constexpr Seconds kFirstPause{1};
constexpr Seconds kLongestPause{60};

fs::path state_file(const fs::path& file) { return fs::path(file).replace_extension(".state"); }

// A reference on its way.
class Rendering {
 public:
  Rendering(const gpu::Context& context, const ReferenceSpec& spec, const LoadedScene& scene, fs::path file,
            const Stopper& stopper, Progress& progress)
      : context_(context),
        spec_(spec),
        scene_(scene),
        file_(std::move(file)),
        stopper_(stopper),
        progress_(progress),
        tracer_(context, scene.scene, spec.settings) {
    for (const std::string& warning : tracer_.warnings()) warn(warning);
  }

  bool restore() {
    const auto complain = [this](const Error& error) {
      progress_.warning(
          fmt::format("this state of a reference cannot be used, so it is rendered from its first "
                      "frame: {}",
                      error.what()));
    };
    const auto stored = read_reference_state(file_, spec_, complain);
    if (!stored) return false;
    try {
      // Whatever may fail, before anything is changed.
      const Json parts = stored->about.at("parts");
      const auto non_finite = stored->about.at("non_finite").get<std::uint64_t>();
      tracer_.restore(stored->state);
      parts_ = parts;
      non_finite_ = non_finite;
    } catch (const std::exception& error) {
      complain(Error(fmt::format("{}: {}", state_file(file_).string(), error.what())));
      return false;
    }
    first_ = frames();
    return true;
  }

  void run() {
    progress_.begin(fmt::format("reference of {}", scene_.scene.name), std::max(frames(), spec_.wish.frames),
                    spec_.work_per_frame(), frames());
    for (int look = spec_.wish.next_look(frames());; look = spec_.wish.next_look(frames() + 1)) {
      render_until(look);
      const ReferenceNoise noise = kept_noise();
      if (spec_.wish.settled(static_cast<std::uint64_t>(frames()), noise)) break;
      expect(noise);
    }
    progress_.end();
  }

  void keep() {
    for (const NonFiniteSample& sample : tracer_.non_finite_samples()) {
      warn(fmt::format("the sample of pixel ({}, {}) in frame {} is not finite", sample.x, sample.y,
                       sample.frame));
    }
    write_state(state_file(file_), state());
    ExrImage exr = to_exr(tracer_.radiance(), {{kReferenceHash, spec_.hash},
                                               {kReferenceNonFinite, std::to_string(non_finite_)},
                                               {kVarianceNote, variance_note(spec_.settings)},
                                               {"seed", std::to_string(spec_.settings.seed)},
                                               {"software", software()}});
    add_halves(exr, tracer_.halves());
    write_exr(file_, exr);
    write_json(fs::path(file_).replace_extension(".json"), sidecar(kept_noise()));
    progress_.note(fmt::format("reference of {}: {} frames rendered{} in {}, kept as {}", scene_.scene.name,
                               frames() - first_,
                               first_ > 0 ? fmt::format(" after {} earlier ones", first_) : "",
                               duration_text(seconds().count()), file_.string()));
  }

 private:
  // As the file will have it, whose numbers are rounded: else a wish could be met here and missed there.
  ReferenceNoise kept_noise() const {
    return *reference_noise(to_radiance(to_exr(tracer_.radiance(), {}), file_));
  }

  int frames() const { return static_cast<int>(tracer_.frames()); }
  Seconds seconds() const { return Clock::now() - start_; }
  void warn(const std::string& text) { progress_.warning(fmt::format("reference {}: {}", spec_.hash, text)); }

  void render_until(int last) {
    while (frames() < last) {
      tracer_.render_frame();
      context_.finish();
      context_.check_alive();
      non_finite_ += tracer_.last_frame_counters().non_finite;
      progress_.step(frames());
      const auto stopped = stopper_.reason();
      if (!stopped && Clock::now() - saved_ < pause_) continue;
      write_state(state_file(file_), state());
      if (stopped) throw *stopped;
      saved_ = Clock::now();
      pause_ = std::min(2 * pause_, kLongestPause);
    }
  }

  // The noise falls with the root of the samples: how many that will take.
  void expect(const ReferenceNoise& noise) {
    const double ratio = noise.relative_error() / spec_.wish.relative_error;
    const double needed = std::min(frames() * ratio * ratio, static_cast<double>(spec_.wish.max_frames));
    progress_.expect(std::max(frames() + 1, static_cast<int>(needed)));
  }

  // What was rendered at a stretch, where, by what and in which time: the earlier parts and this one.
  Json parts() const {
    Json all = parts_;
    if (frames() == first_) return all;
    all.push_back({{"first_frame", first_ + 1},
                   {"last_frame", frames()},
                   {"render_s", seconds().count()},
                   {"ended", utc_now()},
                   {"device", device_json(context_.device())},
                   {"software", software()}});
    return all;
  }

  StoredState state() const {
    return {{{"reference", spec_.hash}, {"parts", parts()}, {"non_finite", non_finite_}}, tracer_.state()};
  }

  Json sidecar(const ReferenceNoise& noise) const {
    return {{"hash", spec_.hash},
            {"definition", spec_.definition},
            {"scene", scene_.scene.name},
            {"samples", frames()},
            {"reference_mse", noise.mse},
            {"reference_relmse", noise.relmse},
            {"reference_relative_error", noise.relative_error()},
            {"non_finite", non_finite_},
            {"parts", parts()}};
  }

  const gpu::Context& context_;
  const ReferenceSpec& spec_;
  const LoadedScene& scene_;
  fs::path file_;
  const Stopper& stopper_;
  Progress& progress_;
  Tracer tracer_;
  int first_ = 0;  // frames that were there before
  std::uint64_t non_finite_ = 0;
  Json parts_ = Json::array();
  Clock::time_point start_ = Clock::now();
  Clock::time_point saved_ = start_;
  Seconds pause_ = kFirstPause;
};

}  // namespace

std::optional<StoredState> read_reference_state(const fs::path& file, const ReferenceSpec& spec,
                                                const std::function<void(const Error&)>& complain) {
  const fs::path beside = state_file(file);
  if (!fs::exists(beside)) return std::nullopt;
  try {
    StoredState stored = read_state(beside);
    check(stored.about.is_object() && stored.about.value("reference", "") == spec.hash,
          "{}: is not of the reference {}", beside.string(), spec.hash);
    return stored;
  } catch (const Error& error) {
    complain(error);
    return std::nullopt;
  }
}

bool render_reference(const gpu::Context& context, const ReferenceSpec& spec, const LoadedScene& scene,
                      const fs::path& file, const Stopper& stopper, Progress& progress) {
  make_folder(file.parent_path());
  Rendering rendering(context, spec, scene, file, stopper, progress);
  const bool extended = rendering.restore();
  rendering.run();
  rendering.keep();
  return extended;
}

}  // namespace qtrace::experiments
