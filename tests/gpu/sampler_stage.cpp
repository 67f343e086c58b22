#include "tests/gpu/sampler_stage.h"

#include "engine/accel/build_bvh.h"
#include "engine/scene/analytic.h"
#include "engine/tracer/parameters.h"
#include "engine/tracer/shader_variant.h"
#include "tests/support/goswami.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace qtrace::test {
namespace {

constexpr int kRows = 32;     // of cos(theta), from -1 to 1
constexpr int kColumns = 48;  // of phi
constexpr int kGrid = 16;     // quadrature points along each side of a cell

// One hit for all invocations: the floor in the middle of the image. A draw that has a density is its
// direction and how far the density told with it is from the one asked for; another is its weight, marked by
// -1, or by -2 where it is told a density all the same.
const char* const kFunctions = R"(
Event the_event() {
  vec3 direction = camera_ray(vec2(parameters.image_size) * 0.5).direction;
  Hit hit = closest_hit(parameters.camera_origin.xyz, direction);
  Event e;
  e.surface = surface_at(hit, direction);
  e.bsdf = bsdf_of(e.surface, -direction);
  e.wo = -direction;
#if SAMPLER == SAMPLER_RL
  e.cell = find_cell(e.surface);
  e.is_guided = e.cell.index != NO_CELL;
  e.bsdf_share = bsdf_share_of(e);
#endif
  return e;
}

vec4 drawn_by_run(Event e, uvec4 bits) {
  DirectionSample s = sample_direction(e, bits);
#ifdef HAS_OWN_LOBES
  if (s.is_delta) return vec4(s.weight, s.pdf == INFINITY ? -1.0 : -2.0);
#else
  if (dot(e.surface.normal, s.direction) <= 0.0) return vec4(0.0, 0.0, 0.0, -1.0);
#endif
  return vec4(s.direction, s.pdf / direction_pdf(e, s.direction));
}

vec4 drawn_by_bsdf(Event e, uvec4 bits) {
  BsdfDraw s = draw_bsdf(e, bits);
  if (s.pdf == INFINITY || s.weight == vec3(0.0)) return vec4(s.weight, -1.0);
  return vec4(s.direction, s.pdf / bsdf_pdf(e, s.direction));
}

float smooth_share(Event e) {
  float share = 0.0;
#ifdef HAS_OWN_LOBES
  OwnShares shares = own_shares(e.surface, e.bsdf, e.wo);
  share = shares.mirror;
#ifdef HAS_TRANSMISSION
  if (passes_one_way(e.bsdf)) share += shares.through;
#endif
#ifdef HAS_CLEARCOAT
  if (is_mirror_coat(e.bsdf)) share += shares.coat;
#endif
#endif
  return share;
}
)";
const std::vector<std::string> kIncludes{"shared/variants.glsl",    "sampling/random.glsl",
                                         "sampling/direction.glsl", "learning/cells.glsl",
                                         "geometry/camera.glsl",    "geometry/traverse.glsl"};

glm::mat3 tilt_of(const SamplerCase& c) {
  return c.tilted ? glm::mat3(glm::rotate(glm::mat4(1), 2.2F, glm::normalize(glm::vec3(1, 0.3F, 0.4F))))
                  : glm::mat3(1);
}

Scene make_scene(const SamplerCase& c) {
  Scene scene = lit_floor(0.8F, 10, 1, 1).scene;
  scene.materials[0] = c.material;
  const glm::mat3 tilt = tilt_of(c);
  for (Triangle& t : scene.triangles) {
    for (glm::vec3& p : t.position) p = tilt * p;
    for (glm::vec3& n : t.normal) n = tilt * n * (c.back ? -1.0F : 1.0F);
    if (c.back) std::swap(t.position[1], t.position[2]);
  }
  // Below the lamp.
  const float sine = std::sqrt(1 - c.cosine * c.cosine);
  const glm::vec3 eye = 0.9F * glm::vec3(sine * std::cos(0.05F), c.cosine, sine * std::sin(0.05F));
  scene.camera = look_at(eye, {0, 0, 0}, 0.1F);
  scene.camera.world_from_camera = glm::mat4(tilt) * scene.camera.world_from_camera;
  return scene;
}

RenderSettings make_settings(const SamplerCase& c) {
  RenderSettings settings;
  settings.rl = goswami_table();
  settings.width = settings.height = 16;
  settings.sampler = c.sampler;
  settings.rl.bsdf_fraction = c.bsdf_fraction;
  // Bins that do not share edges with the grid of the test would blur its quadrature.
  settings.rl.bins_theta = 8;
  settings.rl.bins_phi = 6;
  return settings;
}

std::vector<float> make_table(int kind, std::size_t entries) {
  std::vector<float> values(entries, 0.0F);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform;
  if (kind == 1) {
    for (float& v : values) v = uniform(random);
  }
  if (kind == 2) {
    for (std::size_t i = 0; i < entries; i += 48) values[i + 11] = 1e8F;
  }
  return values;
}

// `d` in a frame of z up.
std::size_t cell_of(glm::dvec3 d) {
  const double turn = std::atan2(d.y, d.x) / (2 * std::numbers::pi);
  const int row = std::clamp(static_cast<int>((d.z + 1) / 2 * kRows), 0, kRows - 1);
  const int column = std::clamp(static_cast<int>((turn < 0 ? turn + 1 : turn) * kColumns), 0, kColumns - 1);
  return static_cast<std::size_t>(row * kColumns + column);
}

}  // namespace

SamplerStage::SamplerStage(const SamplerCase& c)
    : tilt_(tilt_of(c)),
      scene_(make_scene(c)),
      settings_(make_settings(c)),
      buffers_(scene_, build_bvh(scene_, BvhKind::sah)) {
  defines_ = shader_defines(settings_, buffers_.features());
  if (c.sampler == Sampler::rl) {
    table_.emplace(scene_, settings_.rl, table_actions(settings_, buffers_.features()), defines_,
                   device().programs());
  }
  const gpu::Parameters parameters =
      make_parameters(scene_.camera, settings_, buffers_.features(), table_ ? &table_->cells() : nullptr);
  block_.write(0, &parameters, sizeof(parameters));
  block_.bind_uniform(gpu::BINDING_PARAMETERS);
  buffers_.bind();
  counters_.bind_storage(gpu::BINDING_COUNTERS);
  if (table_) table_->set_values(make_table(c.table, table_->values().size()));
}

Draws SamplerStage::draws(Drawer drawer) const {
  const auto samples =
      probe<glm::vec4>("vec4", kIncludes, kFunctions,
                       "uvec4 bits = random_bits(RandomKey(index, 1u, 9u), 1u);\nresult = drawn_by_" +
                           std::string(drawer == Drawer::run ? "run" : "bsdf") + "(the_event(), bits);",
                       kSamples, defines_);
  Draws draws;
  draws.counts.resize(kRows * kColumns);
  double wrong_pdf = 0;
  double squares = 0;
  for (const glm::vec4& s : samples) {
    if (s.w < 0) {
      if (s.w != -1) ++wrong_pdf;
      const double weight = (double{s.x} + double{s.y} + double{s.z}) / 3;
      ++(weight > 0 ? draws.smooth : draws.outside);
      draws.weight += weight / kSamples;
      squares += weight * weight / kSamples;
      continue;
    }
    // The floor's normal is +y: (z, x, y) is a frame with its normal upwards.
    const glm::vec3 d = glm::transpose(tilt_) * glm::vec3(s);
    ++draws.counts[cell_of({d.z, d.x, d.y})];
    if (!(std::abs(s.w - 1) < 1e-3F)) ++wrong_pdf;
  }
  draws.weight_variance = std::max(0.0, squares - draws.weight * draws.weight) / kSamples;
  // Rounding may put a direction at the edge of a bin into the next one.
  EXPECT_LE(wrong_pdf, 1e-4 * kSamples);
  return draws;
}

Stated SamplerStage::stated(Drawer drawer) const {
  const std::string grid = std::to_string(kGrid);
  const std::string columns = std::to_string(kColumns);
  const std::string body = "uint cell = index / " + grid + "u;\nuint line = index % " + grid +
                           "u;\nEvent e = the_event();\nfloat sum = 0.0;\nuint i = 0u;\ndo {\n  float z = "
                           "-1.0 + 2.0 * (float(cell / " +
                           columns + "u) + (float(line) + 0.5) / " + grid + ".0) / " + std::to_string(kRows) +
                           ".0;\n  float phi = 2.0 * PI * (float(cell % " + columns +
                           "u) + (float(i) + 0.5) / " + grid + ".0) / " + columns +
                           ".0;\n  float r = sqrt(1.0 - z * z);\n  sum += " +
                           (drawer == Drawer::run ? "direction_pdf" : "bsdf_pdf") + "(e, " + in_world() +
                           " * vec3(r * sin(phi), z, r * cos(phi)));\n  ++i;\n} while (i < " + grid +
                           "u);\nresult = vec4(sum, smooth_share(e), 0.0, 0.0);";
  const auto sums = probe<glm::vec4>("vec4", kIncludes, kFunctions, body, kRows * kColumns * kGrid, defines_);
  const double point = 4 * std::numbers::pi / (kRows * kColumns * kGrid * kGrid);
  Stated stated;
  stated.counts.resize(kRows * kColumns);
  stated.smooth_share = sums[0].y;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    stated.counts[i / kGrid] += double{sums[i].x} * point * kSamples;
  }
  return stated;
}

// From the frame of the untilted floor.
std::string SamplerStage::in_world() const {
  std::string text = "mat3(";
  for (int i = 0; i < 9; ++i) text += (i > 0 ? ", " : "") + std::to_string(tilt_[i / 3][i % 3]);
  return text + ")";
}

}  // namespace qtrace::test
