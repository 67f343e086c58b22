// The scene on the device.
#pragma once

#include "engine/accel/bvh.h"
#include "engine/device_scene/light_table.h"
#include "engine/device_scene/node_buffers.h"
#include "engine/gpu/buffer.h"
#include "engine/gpu/structs.h"
#include "engine/scene/scene.h"

#include <string>
#include <vector>

namespace qtrace::gpu {

// What a scene needs of the shaders; the rest is not compiled.
struct SceneFeatures {
  bool specular = false;  // any material with a specular lobe
  uint lights = 0;        // connected emitting surfaces
  float brightest = 0;    // mean radiance of the brightest
};

SceneFeatures find_features(const Scene& scene);

class SceneBuffers {
 public:
  SceneBuffers(const Scene& scene, const Bvh& bvh, LightChoice lights = LightChoice::power);

  void bind() const;
  std::size_t bytes() const;
  const SceneFeatures& features() const { return features_; }
  const std::vector<std::string>& warnings() const { return warnings_; }  // one sentence each

 private:
  SceneBuffers(const Scene& scene, const Bvh& bvh, const LightTable& lights);

  SceneFeatures features_;
  std::vector<std::string> warnings_;
  NodeBuffers nodes_;
  Buffer shapes_;
  Buffer shades_;
  Buffer materials_;
  Buffer light_triangles_;
  Buffer lights_;
};

}  // namespace qtrace::gpu
