// Chi-squared: every direction sampler draws in proportion to the density that it states, on the device.
#include "engine/accel/build_bvh.h"
#include "engine/device_scene/scene_buffers.h"
#include "engine/scene/analytic.h"
#include "engine/tracer/parameters.h"
#include "engine/tracer/qtable.h"
#include "engine/tracer/shader_variant.h"
#include "tests/support/goswami.h"
#include "tests/support/probe.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <numbers>
#include <random>

namespace qtrace::test {
namespace {

constexpr int kRows = 32;     // of cos(theta), from -1 to 1
constexpr int kColumns = 48;  // of phi
constexpr int kGrid = 16;     // quadrature points along each side of a cell
constexpr std::uint32_t kSamples = 1 << 18;

// One hit for all invocations: the floor in the middle of the image. `c` = direction in the frame of z up.
const char* const kEvent = R"(
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
)";
const std::vector<std::string> kIncludes{"shared/variants.glsl",    "sampling/random.glsl",
                                         "sampling/direction.glsl", "learning/cells.glsl",
                                         "geometry/camera.glsl",    "geometry/traverse.glsl"};

struct Case {
  std::string name;
  Sampler sampler = Sampler::bsdf;
  double bsdf_fraction = 0;
  int table = 0;  // 0: zeros, 1: random, 2: one huge bin
  float metallic = 0;
  float specular = 0;
  float roughness = 1;
  bool tilted = false;  // the normal points to -z, where the tangent frame takes its other branch
  bool back = false;    // the floor shows its back face
};

std::vector<Case> cases() {
  return {{"Lambert"},
          {"uniform", Sampler::uniform},
          {"rough metal", Sampler::bsdf, 0, 0, 1, 1, 0.8F},
          {"glossy metal", Sampler::bsdf, 0, 0, 1, 1, 0.4F},
          {"plastic", Sampler::bsdf, 0, 0, 0, 1, 0.5F},
          {"table of zeros", Sampler::rl},
          {"random table", Sampler::rl, 0, 1},
          {"one huge bin", Sampler::rl, 0, 2},
          {"random table with Lambert", Sampler::rl, 0.3, 1},
          {"random table with plastic", Sampler::rl, 0.5, 1, 0, 1, 0.5F},
          {"tilted Lambert", Sampler::bsdf, 0, 0, 0, 0, 1, true},
          {"tilted plastic", Sampler::bsdf, 0, 0, 0, 1, 0.5F, true},
          {"tilted uniform", Sampler::uniform, 0, 0, 0, 0, 1, true},
          {"tilted random table", Sampler::rl, 0.3, 1, 0, 0, 1, true},
          {"random table on the back face", Sampler::rl, 0.3, 1, 0, 0, 1, true, true}};
}

glm::mat3 tilt_of(const Case& c) {
  return c.tilted ? glm::mat3(glm::rotate(glm::mat4(1), 2.2F, glm::normalize(glm::vec3(1, 0.3F, 0.4F))))
                  : glm::mat3(1);
}

std::size_t cell_of(glm::dvec3 d) {
  const double turn = std::atan2(d.y, d.x) / (2 * std::numbers::pi);
  const int row = std::clamp(static_cast<int>((d.z + 1) / 2 * kRows), 0, kRows - 1);
  const int column = std::clamp(static_cast<int>((turn < 0 ? turn + 1 : turn) * kColumns), 0, kColumns - 1);
  return static_cast<std::size_t>(row * kColumns + column);
}

class Stage {
 public:
  explicit Stage(const Case& c)
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

  std::vector<double> observed() const {
    const auto samples = probe<glm::vec4>(
        "vec4", kIncludes, kEvent,
        "Event e = the_event();\n"
        "DirectionSample s = sample_direction(e, random_bits(RandomKey(index, 1u, 9u), 1u));\n"
        "result = vec4(s.direction, s.pdf / direction_pdf(e, s.direction));",
        kSamples, defines_);
    std::vector<double> counts(kRows * kColumns);
    double wrong_pdf = 0;
    for (const glm::vec4& s : samples) {
      // The floor's normal is +y: (z, x, y) is a frame with its normal upwards.
      const glm::vec3 d = glm::transpose(tilt_) * glm::vec3(s);
      if (d.y <= 0) continue;  // below the surface, where the BSDF is zero
      ++counts[cell_of({d.z, d.x, d.y})];
      if (!(std::abs(s.w - 1) < 1e-3F)) ++wrong_pdf;
    }
    // Rounding may put a direction at the edge of a bin into the next one.
    EXPECT_LE(wrong_pdf, 1e-4 * kSamples);
    return counts;
  }

  // Integral of the stated density over each cell of the grid, times the number of samples.
  std::vector<double> expected() const {
    const std::string body =
        "uint cell = index / " + std::to_string(kGrid) + "u;\nuint line = index % " + std::to_string(kGrid) +
        "u;\n" + "Event e = the_event();\nfloat sum = 0.0;\nuint i = 0u;\ndo {\n" +
        "  float z = -1.0 + 2.0 * (float(cell / " + std::to_string(kColumns) + "u) + (float(line) + 0.5) / " +
        std::to_string(kGrid) + ".0) / " + std::to_string(kRows) + ".0;\n" +
        "  float phi = 2.0 * PI * (float(cell % " + std::to_string(kColumns) + "u) + (float(i) + 0.5) / " +
        std::to_string(kGrid) + ".0) / " + std::to_string(kColumns) +
        ".0;\n  float r = sqrt(1.0 - z * z);\n" + "  sum += direction_pdf(e, " + tilt_text() +
        " * vec3(r * sin(phi), z, r * cos(phi)));\n  ++i;\n} while (i < " + std::to_string(kGrid) +
        "u);\nresult = vec4(sum);";
    const auto sums = probe<glm::vec4>("vec4", kIncludes, kEvent, body, kRows * kColumns * kGrid, defines_);
    const double point = 4 * std::numbers::pi / (kRows * kColumns * kGrid * kGrid);
    std::vector<double> counts(kRows * kColumns);
    for (std::size_t i = 0; i < sums.size(); ++i) counts[i / kGrid] += double{sums[i].x} * point * kSamples;
    return counts;
  }

 private:
  static Scene make_scene(const Case& c) {
    Scene scene = lit_floor(0.8F, 10, 1, 1).scene;
    scene.materials[0].metallic = c.metallic;
    scene.materials[0].specular = c.specular;
    scene.materials[0].roughness = c.roughness;
    const glm::mat3 tilt = tilt_of(c);
    for (Triangle& t : scene.triangles) {
      for (glm::vec3& p : t.position) p = tilt * p;
      for (glm::vec3& n : t.normal) n = tilt * n * (c.back ? -1.0F : 1.0F);
      if (c.back) std::swap(t.position[1], t.position[2]);
    }
    scene.camera.world_from_camera = glm::mat4(tilt) * scene.camera.world_from_camera;
    return scene;
  }

  std::string tilt_text() const {
    std::string text = "mat3(";
    for (int i = 0; i < 9; ++i) text += (i > 0 ? ", " : "") + std::to_string(tilt_[i / 3][i % 3]);
    return text + ")";
  }

  static RenderSettings make_settings(const Case& c) {
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

  static std::vector<float> make_table(int kind, std::size_t entries) {
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

  glm::mat3 tilt_;
  Scene scene_;
  RenderSettings settings_;
  gpu::SceneBuffers buffers_;
  gpu::Defines defines_;
  std::optional<QTable> table_;
  gpu::Buffer block_{"parameters", sizeof(gpu::Parameters)};
  gpu::Buffer counters_{"counters", 4096};
};

TEST(Samplers, DrawWhatTheyState) {
  device();
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const Stage stage(c);
    const double p = chi_squared_p(stage.observed(), stage.expected());
    EXPECT_GT(p, kFalseAlarm / static_cast<double>(cases().size()));
  }
}

// Random numbers: the four words of a block, and neighbouring pixels, frames and blocks, fill the square of
// any two of them evenly.
TEST(Samplers, RandomNumbersAreUniformAndUncorrelated) {
  device();
  const std::vector<std::string> neighbours{
      "uvec2(random_bits(RandomKey(index, 1u, 9u), 1u).xy)",
      "uvec2(random_bits(RandomKey(index, 1u, 9u), 1u).zw)",
      "uvec2(random_bits(RandomKey(index, 1u, 9u), 1u).x, random_bits(RandomKey(index + 1u, 1u, 9u), 1u).x)",
      "uvec2(random_bits(RandomKey(index, 1u, 9u), 1u).x, random_bits(RandomKey(index, 2u, 9u), 1u).x)",
      "uvec2(random_bits(RandomKey(index, 1u, 9u), 1u).y, random_bits(RandomKey(index, 1u, 9u), 2u).y)",
      "uvec2(random_bits(RandomKey(index, 1u, 9u), 1u).w, random_bits(RandomKey(index, 1u, 10u), 1u).w)"};
  for (const std::string& pair : neighbours) {
    SCOPED_TRACE(pair);
    const auto words = probe<glm::uvec4>("uvec4", {"shared/structs.glsl", "sampling/random.glsl"}, "",
                                         "result = uvec4(" + pair + ", 0u, 0u);", kSamples);
    constexpr std::size_t kSide = 64;
    std::vector<double> counts(kSide * kSide);
    for (const glm::uvec4& w : words) ++counts[(w.x >> 26) * kSide + (w.y >> 26)];
    const std::vector<double> expected(counts.size(),
                                       static_cast<double>(kSamples) / static_cast<double>(counts.size()));
    EXPECT_GT(chi_squared_p(counts, expected), kFalseAlarm / static_cast<double>(neighbours.size()));
  }
}

}  // namespace
}  // namespace qtrace::test
