// Scenes of an experiment, each loaded once.
#pragma once

#include "engine/scene/scene.h"
#include "engine/scene/view.h"
#include "experiments/config/environment_knob.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace qtrace::experiments {

struct LoadedScene {
  std::filesystem::path file;
  View view;
  Scene scene;
  std::string hash;                          // of its content, see hash.h
  std::filesystem::path environment_file{};  // of the image around it; empty: none
};

class SceneStore {
 public:
  // The reference stays valid as long as the store. Throws Error that names the file.
  const LoadedScene& load(const std::filesystem::path& file, const View& view = {},
                          const std::optional<EnvironmentImage>& environment = {});

 private:
  std::map<std::string, LoadedScene> scenes_;  // by file, view and environment
};

// The parts of a view that are not the file's own, for people: "", or ", camera \"fit\"".
std::string view_text(const View& view);

// The same of an image around the scene: "", or ", environment {\"file\":...}".
std::string environment_text(const std::optional<EnvironmentImage>& environment);

// Whether any triangle emits, or the image around the scene does.
bool has_light(const Scene& scene);

}  // namespace qtrace::experiments
