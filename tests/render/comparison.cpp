#include "tests/render/comparison.h"

#include "engine/scene/analytic.h"
#include "engine/gltf/load_gltf.h"
#include "tests/support/goswami.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace qtrace::test {

RenderSettings base_settings(std::uint32_t seed) {
  RenderSettings settings;
  settings.random = RandomNumbers::independent;
  settings.rl = goswami_table();
  settings.width = settings.height = kSize;
  settings.max_bounces = 4;
  settings.seed = seed;
  settings.rl.sites_per_object = 40;
  settings.rl.bins_theta = settings.rl.bins_phi = 6;
  return settings;
}

Scene shipped(const char* name) {
  return load_gltf(std::string(QTRACE_SOURCE_DIR) + "/configs/scenes/" + name);
}

Scene glossy_room() {
  Scene scene = shipped("cornell_box.glb");
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    Material& m = scene.materials[i];
    m.metallic = i % 3 == 0 ? 0.8F : 0.0F;
    m.specular = i % 3 == 1 ? 0.7F : 1.0F;
    m.roughness = i % 2 == 0 ? 0.5F : 0.7F;  // broad enough for uniform directions to find the highlights
  }
  scene.materials.push_back(lambert(glm::vec3(0.2F), glm::vec3(2, 4, 6)));
  scene.materials.back().double_sided = true;
  add_quad(scene, {1.2F, 2, 0}, {0.8F, 0.3F, 0}, {0, 0.8F, 0.4F},
           static_cast<std::uint32_t>(scene.materials.size() - 1));
  return scene;
}

void expect_same_image(const Rendering& a, const Rendering& b, std::size_t comparisons, int size) {
  EXPECT_EQ(a.non_finite, 0U);
  const int row = kSize / size;
  for (int i = 0; i < row * row; ++i) {
    const int x = i % row * size;
    const int y = i / row * size;
    const Estimate ea = block_estimate(a.image, x, y, size);
    const Estimate eb = block_estimate(b.image, x, y, size);
    EXPECT_LT(z_score(ea, eb), z_threshold(comparisons))
        << "block at (" << x << ", " << y << "): " << ea.mean << " +- " << std::sqrt(ea.variance)
        << " against " << eb.mean << " +- " << std::sqrt(eb.variance);
  }
}

}  // namespace qtrace::test
