// A small table over a lit floor, taught by hand.
#pragma once

#include "engine/accel/build_bvh.h"
#include "engine/device_scene/scene_buffers.h"
#include "engine/scene/analytic.h"
#include "engine/tracer/parameters.h"
#include "engine/tracer/qtable.h"
#include "engine/tracer/shader_variant.h"
#include "tests/support/goswami.h"
#include "tests/support/probe.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

namespace qtrace::test {

// Sets `s` to what the middle of the image shows, seen along `d`.
inline const std::string kViewedSurface =
    "vec3 d = camera_ray(vec2(parameters.image_size) * 0.5).direction;\n"
    "Surface s = surface_at(closest_hit(parameters.camera_origin.xyz, d), d);\n";

class LearningStage : public testing::Test {
 protected:
  LearningStage() {
    scene_ = lit_floor(0.8F, 10, 1, 1).scene;
    settings_.rl = goswami_table();
    settings_.rl.sites_per_object = 4;
    settings_.rl.bins_theta = settings_.rl.bins_phi = 2;
    build();
  }

  // Anew, from scene and settings as they are.
  void build() {
    buffers_.emplace(scene_, build_bvh(scene_, BvhKind::sah));
    defines_ = shader_defines(settings_, buffers_->features());
    table_.emplace(scene_, settings_.rl, table_actions(settings_, buffers_->features()), defines_,
                   device().programs());
    const gpu::Parameters parameters =
        make_parameters(scene_.camera, settings_, buffers_->features(), &table_->cells());
    block_.write(0, &parameters, sizeof(parameters));
    block_.bind_uniform(gpu::BINDING_PARAMETERS);
    counters_.bind_storage(gpu::BINDING_COUNTERS);
    buffers_->bind();
    table_->reset();
  }

  // `count` threads each give the target `expression` to entry `entry`; then the frame's update.
  void teach(const std::string& entry, const std::string& expression, std::uint32_t count) {
    table_->bind();
    probe<glm::uvec4>("uvec4", {"shared/variants.glsl", "learning/qtable.glsl"}, "",
                      "result = uvec4(gather_target(" + entry + ", " + expression + ") ? 1u : 0u);", count,
                      defines_);
    counters_.bind_storage(gpu::BINDING_COUNTERS);
    table_->learn();
    device().finish();
  }

  // What the viewed surface adds to a target that arrives there, for `count` rotations of the expectation.
  std::vector<float> next_values_in_view(std::uint32_t count = 1) const {
    std::vector<float> values;
    for (const glm::vec4& v : probe<glm::vec4>(
             "vec4",
             {"shared/variants.glsl", "learning/cells.glsl", "learning/qtable.glsl", "geometry/camera.glsl",
              "geometry/traverse.glsl", "sampling/random.glsl"},
             "",
             kViewedSurface +
                 "vec3 rotation = random_units(RandomKey(index, 1u, 5u), 1u).xyz;\n"
                 "result = vec4(next_value(s, bsdf_of(s, -d), -d, find_cell(s), vec3(0.5), rotation));",
             count, defines_)) {
      values.push_back(v.x);
    }
    return values;
  }

  const gpu::Context& context_ = device();  // before the first buffer
  Scene scene_;
  RenderSettings settings_;
  std::optional<gpu::SceneBuffers> buffers_;
  gpu::Defines defines_;
  std::optional<QTable> table_;
  gpu::Buffer block_{"parameters", sizeof(gpu::Parameters)};
  gpu::Buffer counters_{"counters", 4096};
};

}  // namespace qtrace::test
