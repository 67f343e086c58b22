// The numbers of one material, checked; messages name it.
#pragma once

#include "engine/gltf_document/source.h"

#include <glm/vec3.hpp>

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace qtrace::gltf {

inline constexpr float kNoLimit = std::numeric_limits<float>::max();

class Factors {
 public:
  Factors(Source& source, const tinygltf::Material& file, std::string material)
      : source_(source), file_(file), material_(std::move(material)) {}

  // Error for values outside of 0 to `max`. What is so by rounding is clamped, with a warning.
  float scalar(std::string_view property, double value, float max) const;
  glm::vec3 rgb(std::string_view property, const std::vector<double>& value, float max) const;

  bool has(const std::string& extension) const { return file_.extensions.contains(extension); }
  // Of an extension; `otherwise` where the material does not have it.
  double number(const std::string& extension, const std::string& property, double otherwise) const;
  float scalar_of(const std::string& extension, const std::string& property, double otherwise,
                  float max) const;
  glm::vec3 rgb_of(const std::string& extension, const std::string& property, float max) const;  // else white

  const std::string& material() const { return material_; }

 private:
  const tinygltf::Value* find(const std::string& extension, const std::string& property) const;

  Source& source_;
  const tinygltf::Material& file_;
  std::string material_;
};

}  // namespace qtrace::gltf
