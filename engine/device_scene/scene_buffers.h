// The scene on the device.
#pragma once

#include "engine/accel/bvh.h"
#include "engine/device_scene/light_table.h"
#include "engine/device_scene/node_buffers.h"
#include "engine/device_scene/scene_features.h"
#include "engine/device_scene/texture_table.h"
#include "engine/gpu/buffer.h"
#include "engine/gpu/structs.h"
#include "engine/scene/scene.h"

#include <string>
#include <vector>

namespace qtrace::gpu {

// Throws Error, by name, where the device does not allow so many texels as the scene's textures have.
void check_texels(const Scene& scene);

class SceneBuffers {
 public:
  SceneBuffers(const Scene& scene, const Bvh& bvh, LightChoice lights = LightChoice::power);

  void bind() const;
  std::size_t bytes() const;
  const SceneFeatures& features() const { return features_; }
  const std::vector<std::string>& warnings() const { return warnings_; }  // one sentence each

 private:
  SceneBuffers(const Scene& scene, const Bvh& bvh, const LightTable& lights, const TextureTable& textures);

  SceneFeatures features_;
  std::vector<std::string> warnings_;
  NodeBuffers nodes_;
  Buffer shapes_;
  Buffer shades_;
  Buffer materials_;
  Buffer light_triangles_;
  Buffer lights_;
  Buffer texels_;
};

}  // namespace qtrace::gpu
