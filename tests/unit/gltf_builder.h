// Assembles small glTF files, right or wrong, for the loader's tests.
#pragma once

#include "engine/scene/scene.h"
#include "engine/scene/view.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace qtrace {

constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kUnsignedInt = 5125,
              kFloat = 5126;
constexpr int kPoints = 0, kLines = 1, kLineLoop = 2, kLineStrip = 3, kTriangles = 4, kStrip = 5, kFan = 6;

// A folder of its own, removed with all that is in it.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::string& name, std::string_view bytes) const;

 private:
  std::filesystem::path path_;
};

// Starts with a camera in node 0 and nothing else; `json` and `binary` are open to be spoilt.
class GltfBuilder {
 public:
  GltfBuilder();

  template <class T>
  std::size_t add_accessor(const std::vector<T>& values, const char* type, int component_type) {
    const auto* bytes = reinterpret_cast<const char*>(values.data());
    return add_accessor(std::string_view(bytes, values.size() * sizeof(T)), values.size(), type,
                        component_type);
  }
  std::size_t add_floats(const char* type, const std::vector<float>& components);
  std::size_t add_indices(const std::vector<std::uint32_t>& indices, int component_type = kUnsignedInt);

  // An image in a bufferView of its own, and a texture of it; returns the texture's index.
  std::size_t add_texture(const std::string& image, const std::string& media_type = "image/png");
  // The first, which the first primitive has from then on.
  nlohmann::json& material();

  // A primitive with POSITION alone, to be extended.
  nlohmann::json primitive(const std::vector<float>& positions);
  std::size_t add_mesh(nlohmann::json primitives, const std::string& name = "");
  std::size_t add_node(nlohmann::json node);  // a root of scene 0
  // Node 'thing' with mesh 'shape': one triangle (0,0,0) (1,0,0) (0,1,0), which faces +z.
  void add_triangle();

  nlohmann::json& primitive_json() { return json["meshes"][0]["primitives"][0]; }

  std::string glb() const;
  std::string gltf_with(const std::string& uri) const;
  std::string data_uri() const;

  nlohmann::json json;
  std::string binary;

 private:
  std::size_t add_accessor(std::string_view bytes, std::size_t values, const char* type, int component_type);
};

class GltfTest : public ::testing::Test {
 protected:
  Scene load() const;  // gltf, written as scene.glb
  Scene load(const View& view) const;
  Scene load(const std::string& name, std::string_view bytes) const;
  // The loader must refuse the file with a message that holds the file's name and each of `parts`.
  void expect_error(std::initializer_list<std::string_view> parts) const;
  void expect_error(const std::filesystem::path& file, std::initializer_list<std::string_view> parts) const;
  void expect_error(const View& view, std::initializer_list<std::string_view> parts) const;
  // The scene must load with one warning, which is `warning`.
  void expect_warning(std::string_view warning) const;

  TempFolder folder;
  GltfBuilder gltf;
};

}  // namespace qtrace
