// Scenes of an experiment, each loaded once.
#pragma once

#include "engine/scene/scene.h"
#include "engine/scene/view.h"

#include <filesystem>
#include <map>
#include <string>

namespace qtrace::experiments {

struct LoadedScene {
  std::filesystem::path file;
  View view;
  Scene scene;
  std::string hash;  // of its content, see hash.h
};

class SceneStore {
 public:
  // The reference stays valid as long as the store. Throws Error that names the file.
  const LoadedScene& load(const std::filesystem::path& file, const View& view = {});

 private:
  std::map<std::string, LoadedScene> scenes_;  // by file and view
};

// The parts of a view that are not the file's own, for people: "", or ", camera \"fit\"".
std::string view_text(const View& view);

// Whether any triangle emits.
bool has_light(const Scene& scene);

}  // namespace qtrace::experiments
