#include "engine/tracer/parameters.h"

#include <algorithm>
#include <cmath>

namespace qtrace {

gpu::Parameters make_parameters(const Camera& camera, const RenderSettings& settings,
                                const gpu::SceneFeatures& features, const CellBuffers* cells) {
  const auto whole = [](int value) { return static_cast<gpu::uint>(value); };
  const auto real = [](double value) { return static_cast<float>(value); };
  const float up = std::tan(camera.vertical_fov / 2);
  const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
  const glm::mat4& m = camera.world_from_camera;
  const auto& e = settings.environment;
  gpu::Parameters p{};
  p.camera_origin = m[3];
  p.camera_right = m[0] * (up * aspect);
  p.camera_up = m[1] * up;
  p.camera_forward = -m[2];
  const float brightest = std::max(features.brightest, real((e[0] + e[1] + e[2]) / 3));
  p.environment = glm::vec4(real(e[0]), real(e[1]), real(e[2]), brightest > 0 ? 1 / brightest : 0);
  p.rl = glm::vec4(real(settings.rl.bsdf_fraction), real(settings.rl.bin_floor),
                   real(settings.rl.cell_normal_threshold), real(settings.light_floor));
  p.learning = glm::vec4(real(settings.rl.rate_constant), real(settings.rl.rate_exponent),
                         real(settings.rl.initial_value), static_cast<float>(settings.light_prior));
  p.film = glm::vec4(real(settings.clamp_radiance), 0, 0, 0);
  p.shaping = glm::vec4(real(settings.rl.shrinkage), real(settings.rl.roulette_scale),
                        static_cast<float>(settings.rl.guided_bounces), 0);
  p.image = glm::uvec4(whole(settings.width), whole(settings.height), settings.seed, 0);
  p.path = glm::uvec4(whole(settings.max_bounces), whole(settings.russian_roulette_start), features.lights,
                      cells != nullptr ? cells->count() : 0);
  if (cells != nullptr) {
    p.grid = glm::vec4(cells->grid().origin, cells->grid().boxes_per_unit);
    p.grid_boxes = glm::uvec4(cells->grid().boxes, 0);
  }
  return p;
}

}  // namespace qtrace
