// What a scene needs of the shaders; the rest is not compiled.
#pragma once

#include "engine/device_scene/light_table.h"
#include "engine/gpu/structs.h"
#include "engine/scene/scene.h"

namespace qtrace::gpu {

struct SceneFeatures {
  bool specular = false;      // any material with a specular lobe
  uint textures = 0;          // a bit for each TextureSlot that some material uses
  bool tangents = false;      // of textures of normals
  bool colors = false;        // of vertices
  bool transmission = false;  // light passes surfaces
  bool absorption = false;    // in a volume behind them
  bool clearcoat = false;
  bool delta = false;  // lobes that are a mirror's
  bool unlit = false;
  bool alpha = false;     // surfaces that rays may pass
  uint lights = 0;        // of every kind, the environment's image among them
  bool punctual = false;  // lights without a surface
  glm::uvec2 sky{0};    // columns and rows of the environment's image, which is the last light; 0 without one
  float sky_turn = 0;   // its rotation, as a part of all longitudes
  float reach = 0;      // a length that leads out of the scene
  float brightest = 0;  // mean radiance of the brightest
  float power = 0;      // of all lights, in units of power_of_lamp() (light_table.cpp)
  glm::vec3 centre{0};  // of a sphere about all that stands in the scene
  float radius = 0;
};

SceneFeatures find_features(const Scene& scene);
SceneFeatures find_features(const Scene& scene, const LightTable& lights);

bool has_specular_lobe(const qtrace::Material& material);

}  // namespace qtrace::gpu
