#include "engine/tracer/parameters.h"

#include "engine/device_scene/light_table.h"
#include "engine/tracer/light_vertices.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace qtrace {

gpu::Parameters make_parameters(const Camera& camera, const RenderSettings& settings,
                                const gpu::SceneFeatures& features, const CellBuffers* cells) {
  const auto whole = [](int value) { return static_cast<gpu::uint>(value); };
  const auto real = [](double value) { return static_cast<float>(value); };
  const RlSettings& rl = settings.rl;
  const bool is_flat = camera.film_height > 0;
  const float up = is_flat ? camera.film_height / 2 : std::tan(camera.vertical_fov / 2);
  const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
  const glm::mat4& m = camera.world_from_camera;
  const auto& e = settings.environment;
  gpu::Parameters p{};
  p.camera_origin = m[3];
  (is_flat ? p.film_right : p.camera_right) = m[0] * (up * aspect);
  (is_flat ? p.film_up : p.camera_up) = m[1] * up;
  p.camera_forward = -m[2];
  const double mean_environment = (e[0] + e[1] + e[2]) / 3;
  const float brightest = std::max(features.brightest, real(mean_environment));
  p.environment = glm::vec3(real(e[0]), real(e[1]), real(e[2]));
  p.inverse_brightest = brightest > 0 ? 1 / brightest : 0;
  if (cells != nullptr) {
    p.grid_origin = cells->grid().origin;
    p.grid_boxes_per_unit = cells->grid().boxes_per_unit;
    p.grid_boxes = cells->grid().boxes;
    p.cells = cells->count();
  }
  p.image_size = glm::uvec2(whole(settings.width), whole(settings.height));
  p.seed = settings.seed;
  p.lights = features.lights;
  p.light_prior = whole(settings.light_prior);
  p.max_bounces = whole(settings.max_bounces);
  p.russian_roulette_start = whole(settings.russian_roulette_start);
  p.guided_bounces = whole(rl.guided_bounces);
  p.clamp_radiance = real(settings.clamp_radiance);
  p.bsdf_fraction = real(rl.bsdf_fraction);
  p.bin_floor = real(rl.bin_floor);
  p.light_floor = real(settings.light_floor);
  p.cell_normal_threshold = real(rl.cell_normal_threshold);
  p.rate_constant = real(rl.rate_constant);
  p.rate_exponent = real(rl.rate_exponent);
  p.initial_value = real(rl.initial_value);
  p.shrinkage = real(rl.shrinkage);
  p.roulette_scale = real(rl.roulette_scale);
  p.sky_size = features.sky;
  p.sky_first = features.lights * static_cast<gpu::uint>(sizeof(gpu::Light) / sizeof(gpu::vec4));
  p.sky_turn = features.sky_turn;
  p.reach = features.reach;
  p.light_paths = whole(light_paths_of_a_frame(settings));
  p.kept_paths = kept_light_paths(settings);
  p.connections = 1;
  p.scene_centre = features.centre;
  p.scene_radius = features.radius;
  const double sky = gpu::power_of_environment(mean_environment, features.radius);
  p.disk_pdf = real(1 / (std::numbers::pi * features.radius * features.radius));
  p.pixel_area = 4 * up * up * aspect / static_cast<float>(settings.width * settings.height);
  p.environment_share = sky > 0 ? real(sky / (sky + features.power)) : 0.0F;
  return p;
}

}  // namespace qtrace
