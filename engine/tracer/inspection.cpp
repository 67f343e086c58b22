#include "engine/tracer/inspection.h"

#include "engine/accel/build_bvh.h"
#include "engine/device_scene/scene_buffers.h"
#include "engine/gpu/program.h"
#include "engine/gpu/structs.h"
#include "engine/tracer/film.h"
#include "engine/tracer/limits.h"
#include "engine/tracer/parameters.h"
#include "engine/tracer/shader_variant.h"
#include "engine/tracer/tiles.h"

#include <limits>

namespace qtrace {
namespace {

// Of the paths that are traced for comparison.
RenderSettings truth_settings(RenderSettings settings) {
  settings.sampler = Sampler::bsdf;
  settings.nee = Nee::one_ray;
  settings.lights = LightChoice::power;
  settings.seed = ~settings.seed;
  return settings;
}

// Cells and bins as the run has them, and paths without a table.
gpu::Defines inspection_defines(const RenderSettings& settings, const gpu::SceneFeatures& features) {
  gpu::Defines defines = shader_defines(settings, features);
  for (const auto& [name, value] : shader_defines(truth_settings(settings), features)) defines[name] = value;
  defines.erase("HAS_TABLE");
  return defines;
}

// Sums over the paths of a hemisphere.
class Sums {
 public:
  Sums(std::size_t pixels, std::size_t bins)
      : radiance_(pixels), paths_(pixels), bin_radiance_(bins), bin_paths_(bins), cosine_(bins) {}

  void add(const std::vector<gpu::Incident>& incidents) {
    for (std::size_t i = 0; i < incidents.size(); ++i) {
      const gpu::Incident& incident = incidents[i];
      if (incident.path_bin == gpu::NO_BIN) continue;
      const glm::dvec3 radiance(incident.radiance);
      radiance_[i] += radiance;
      ++paths_[i];
      bin_radiance_[incident.path_bin] += (radiance.r + radiance.g + radiance.b) / 3;
      ++bin_paths_[incident.path_bin];
      cosine_[incident.path_bin] = static_cast<double>(incident.bin_cosine);
    }
  }

  Hemisphere means(int size, const std::vector<gpu::Incident>& incidents) const {
    Hemisphere result{size, {}, {}, {}, cosine_};
    for (std::size_t i = 0; i < incidents.size(); ++i) {
      result.bin.push_back(
          incidents[i].centre_bin == gpu::NO_BIN ? -1 : static_cast<int>(incidents[i].centre_bin));
      result.radiance.push_back(paths_[i] > 0 ? radiance_[i] / paths_[i] : glm::dvec3(0));
    }
    for (std::size_t b = 0; b < bin_paths_.size(); ++b) {
      result.bin_radiance.push_back(bin_paths_[b] > 0 ? bin_radiance_[b] / bin_paths_[b]
                                                      : std::numeric_limits<double>::quiet_NaN());
    }
    return result;
  }

 private:
  std::vector<glm::dvec3> radiance_;
  std::vector<double> paths_;
  std::vector<double> bin_radiance_;
  std::vector<double> bin_paths_;
  std::vector<double> cosine_;
};

}  // namespace

struct Inspection::State {
  // `wanted`: without light paths, since what is compared is what a single path of the camera finds.
  State(const gpu::Context& context, const Scene& scene, const RenderSettings& wanted)
      : settings(wanted),
        buffers(scene, build_bvh(scene, wanted.bvh), truth_settings(wanted).lights),
        cells(scene, wanted.rl),
        film(1, 1, 1, 0, context.programs()),
        parameter_block("parameters", sizeof(gpu::Parameters)),
        defines(inspection_defines(wanted, buffers.features())) {
    const gpu::Parameters parameters =
        make_parameters(scene.camera, truth_settings(wanted), buffers.features(), &cells);
    parameter_block.write(0, &parameters, sizeof(parameters));
  }

  void bind(const gpu::Buffer& output) const {
    parameter_block.bind_uniform(gpu::BINDING_PARAMETERS);
    buffers.bind();
    cells.bind();
    film.bind();
    output.bind_storage(gpu::BINDING_OUTPUT);
  }

  RenderSettings settings;
  gpu::SceneBuffers buffers;
  CellBuffers cells;
  Film film;  // for its watch over cut loops
  gpu::Buffer parameter_block;
  gpu::Defines defines;
};

Inspection::Inspection(const gpu::Context& context, const Scene& scene, const RenderSettings& settings) {
  check_limits(context, scene, settings);
  RenderSettings of_camera = settings;
  of_camera.light_paths = LightPaths::none;
  state_ = std::make_unique<State>(context, scene, of_camera);
}

Inspection::~Inspection() = default;
Inspection::Inspection(Inspection&&) noexcept = default;
Inspection& Inspection::operator=(Inspection&&) noexcept = default;

const std::vector<CellState>& Inspection::cells() const { return state_->cells.states(); }

std::size_t Inspection::actions() const {
  const gpu::SceneFeatures& features = state_->buffers.features();
  return table_actions(effective_settings(state_->settings, features), features);
}

std::vector<int> Inspection::pixel_cells() const {
  const State& s = *state_;
  const auto pixels =
      static_cast<std::size_t>(s.settings.width) * static_cast<std::size_t>(s.settings.height);
  const gpu::Buffer output("cells of pixels", pixels * sizeof(int));
  s.bind(output);
  const gpu::Program program("passes/inspect_cells.comp", s.defines);
  program.dispatch(tiles(s.settings.width), tiles(s.settings.height));
  s.film.check_loops();
  return output.read_all<int>();
}

Hemisphere Inspection::hemisphere(glm::ivec2 pixel, int size, int samples,
                                  const std::function<void(int)>& after_each) const {
  const State& s = *state_;
  gpu::Defines defines = s.defines;
  defines["PIXEL_X"] = std::to_string(pixel.x);
  defines["PIXEL_Y"] = std::to_string(pixel.y);
  defines["HEMISPHERE_SIZE"] = std::to_string(size);
  gpu::Program program("passes/incident.comp", defines);
  const auto pixels = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  const gpu::Buffer output("incident radiance", pixels * sizeof(gpu::Incident));
  s.bind(output);
  Sums sums(pixels, static_cast<std::size_t>(s.settings.rl.bins_theta * s.settings.rl.bins_phi));
  for (int sample = 1; sample <= samples; ++sample) {
    program.set_frame(static_cast<std::uint32_t>(sample));
    program.dispatch(tiles(size), tiles(size));
    sums.add(output.read_all<gpu::Incident>());
    if (after_each) after_each(sample);
  }
  s.film.check_loops();
  return sums.means(size, output.read_all<gpu::Incident>());
}

}  // namespace qtrace
