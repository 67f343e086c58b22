// What a scene needs of the shaders; the rest is not compiled.
#pragma once

#include "engine/device_scene/light_table.h"
#include "engine/gpu/structs.h"
#include "engine/scene/scene.h"

namespace qtrace::gpu {

struct SceneFeatures {
  bool specular = false;  // any material with a specular lobe
  uint textures = 0;      // a bit for each TextureSlot that some material uses
  bool tangents = false;  // of textures of normals
  bool colors = false;    // of vertices
  uint lights = 0;        // connected emitting surfaces
  float brightest = 0;    // mean radiance of the brightest
};

SceneFeatures find_features(const Scene& scene);
SceneFeatures find_features(const Scene& scene, const LightTable& lights);

bool has_specular_lobe(const qtrace::Material& material);

}  // namespace qtrace::gpu
