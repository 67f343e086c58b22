// What the device finds in the grid of cells: the box that the hit lies in, and the axis of its normal.
#include "engine/accel/build_bvh.h"
#include "engine/core/check.h"
#include "engine/device_scene/scene_buffers.h"
#include "engine/gltf/load_gltf.h"
#include "engine/tracer/limits.h"
#include "engine/tracer/parameters.h"
#include "engine/tracer/shader_variant.h"
#include "tests/support/goswami.h"
#include "tests/support/probe.h"
#include "tests/support/render.h"

#include <gtest/gtest.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

namespace qtrace::test {
namespace {

constexpr int kSize = 128;

Scene shipped(const std::string& name) {
  return load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/" + name + ".glb");
}

RenderSettings grid_settings(int resolution) {
  RenderSettings settings;
  settings.rl = goswami_table();
  settings.width = settings.height = kSize;
  settings.rl.cells = CellKind::grid;
  settings.rl.grid_resolution = resolution;
  return settings;
}

// What every pixel sees, and what it sees mirrored there: `result` holds the cell and one of the hit's
// vectors.
std::vector<glm::vec4> hits(const gpu::Defines& defines, const std::string& vector) {
  return probe<glm::vec4>(
      "vec4",
      {"shared/variants.glsl", "learning/cells.glsl", "geometry/camera.glsl", "geometry/traverse.glsl"}, "",
      "uint pixel = index >> 1;\n"
      "vec3 d = camera_ray(vec2(pixel % parameters.image_size.x, pixel / parameters.image_size.x) + "
      "0.5).direction;\n"
      "Hit hit = closest_hit(parameters.camera_origin.xyz, d);\n"
      "result = vec4(-2.0);\n"
      "if (hit.triangle == NO_TRIANGLE) { results[index] = result; return; }\n"
      "Surface s = surface_at(hit, d);\n"
      "if ((index & 1u) == 1u) {\n"
      "  d = reflect(d, s.geometric_normal);\n"
      "  hit = closest_hit(ray_origin(s, d), d);\n"
      "  if (hit.triangle == NO_TRIANGLE) { results[index] = result; return; }\n"
      "  s = surface_at(hit, d);\n"
      "}\n"
      "result = vec4(s." +
          vector + ", float(find_cell(s).index));",
      2 * kSize * kSize, defines);
}

void expect_cells_of_hits(const Scene& scene, int resolution) {
  device();
  const RenderSettings settings = grid_settings(resolution);
  const gpu::SceneBuffers buffers(scene, build_bvh(scene, BvhKind::sah), settings.lights);
  buffers.bind();
  const CellBuffers cells(scene, settings.rl);
  cells.bind();
  const gpu::Parameters parameters = make_parameters(scene.camera, settings, buffers.features(), &cells);
  gpu::Buffer block("parameters", sizeof(parameters));
  block.write(0, &parameters, sizeof(parameters));
  block.bind_uniform(gpu::BINDING_PARAMETERS);
  const gpu::Defines defines = shader_defines(settings, buffers.features());
  const std::vector<glm::vec4> positions = hits(defines, "position");
  const std::vector<glm::vec4> normals = hits(defines, "normal");
  const float half_side = 0.5F / cells.grid().boxes_per_unit;
  int found = 0;
  int wrong = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (positions[i].w == -2) continue;
    ++found;
    if (positions[i].w < 0 || positions[i].w >= static_cast<float>(cells.count())) {
      ++wrong;
      continue;
    }
    const CellState& cell = cells.states()[static_cast<std::size_t>(positions[i].w)];
    const glm::vec3 off = glm::abs(glm::vec3(positions[i]) - cell.position);
    const glm::vec3 size = glm::abs(glm::vec3(normals[i]));
    const bool is_inside = std::max({off.x, off.y, off.z}) < 1.001F * half_side;
    const bool is_along =
        glm::dot(glm::vec3(normals[i]), cell.normal) > std::max({size.x, size.y, size.z}) - 1e-6F;
    if (!is_inside || !is_along) ++wrong;
  }
  EXPECT_GT(found, kSize * kSize);
  EXPECT_EQ(wrong, 0) << "of " << found;
}

TEST(Grid, HitsFindTheirBoxAndAxis) {
  for (const char* scene : {"simple", "occluded", "cornell_box"}) {
    for (const int resolution : {1, 5, 16, 100}) {
      SCOPED_TRACE(testing::Message() << scene << " at " << resolution);
      expect_cells_of_hits(shipped(scene), resolution);
    }
  }
}

TEST(Grid, NearlyNoHitOfAPathIsWithoutACell) {
  for (const char* name : {"simple", "occluded", "cornell_box"}) {
    SCOPED_TRACE(name);
    RenderSettings settings = grid_settings(16);
    settings.rl.bins_theta = settings.rl.bins_phi = 4;
    Tracer tracer(device(), shipped(name), settings);
    std::uint64_t lookups = 0;
    std::uint64_t fallbacks = 0;
    for (int i = 0; i < 4; ++i) {
      tracer.render_frame();
      lookups += tracer.last_frame_counters().cell_lookups;
      fallbacks += tracer.last_frame_counters().cell_fallbacks;
    }
    EXPECT_GT(lookups, 4U * kSize * kSize);
    EXPECT_LT(static_cast<double>(fallbacks), 1e-5 * static_cast<double>(lookups));
  }
}

TEST(Grid, CountIsWhatIsBuilt) {
  device();
  const Scene scene = shipped("simple");
  for (const int resolution : {1, 16}) {
    const RlSettings settings = grid_settings(resolution).rl;
    EXPECT_EQ(CellBuffers::count(scene, settings), CellBuffers(scene, settings).count());
  }
}

TEST(Grid, TooFineAGridIsRefusedByName) {
  if (!device().device().software) GTEST_SKIP() << "this device may hold it";
  try {
    check_limits(device(), shipped("cornell_box"), grid_settings(512));
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("rl.grid_resolution"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace qtrace::test
