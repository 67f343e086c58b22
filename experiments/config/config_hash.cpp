#include "experiments/config/config_hash.h"

#include "experiments/files/hash.h"

namespace qtrace::experiments {

std::string config_hash(const RunConfig& config, const std::string& scene_hash) {
  Json json = write_knobs(config, Written::identity);
  json.erase("name");
  json.erase("save_table");
  json.erase("expect");
  if (config.environment_image) json["environment"] = config.render.environment;  // the scene has the image
  for (const char* part_of_scene : {"gltf_scene", "camera"}) json.erase(part_of_scene);
  for (const std::string_view key : kKeysOfExecution) json.erase(std::string(key));
  json["scene"] = scene_hash;
  return hash_text(canonical_text(json));
}

}  // namespace qtrace::experiments
