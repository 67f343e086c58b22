// Scenes of an experiment, each loaded once.
#pragma once

#include "engine/scene/scene.h"

#include <filesystem>
#include <map>
#include <string>

namespace qtrace::experiments {

struct LoadedScene {
  std::filesystem::path file;
  Scene scene;
  std::string hash;  // of its content, see hash.h
};

class SceneStore {
 public:
  // The reference stays valid as long as the store. Throws Error that names the file.
  const LoadedScene& load(const std::filesystem::path& file);

  const std::map<std::filesystem::path, LoadedScene>& all() const { return scenes_; }

 private:
  std::map<std::filesystem::path, LoadedScene> scenes_;
};

// Whether any triangle emits.
bool has_light(const Scene& scene);

}  // namespace qtrace::experiments
