#include "tests/unit/gltf_builder.h"

#include "engine/core/check.h"
#include "engine/gltf/load_gltf.h"

#include <unistd.h>

#include <cstdint>
#include <fstream>

namespace qtrace {
namespace {

std::size_t component_count(std::string_view type) {
  if (type == "SCALAR") return 1;
  if (type == "MAT4") return 16;
  return type == "VEC2" ? 2 : type == "VEC3" ? 3 : 4;
}

void append_word(std::string& bytes, std::size_t value) {
  for (unsigned shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xffU);
}

std::string padded(std::string bytes, char filler) {
  while (bytes.size() % 4 != 0) bytes += filler;
  return bytes;
}

template <class T>
std::string narrowed(const std::vector<std::uint32_t>& values) {
  std::string bytes;
  for (const std::uint32_t value : values) {
    const T narrow = static_cast<T>(value);
    bytes.append(reinterpret_cast<const char*>(&narrow), sizeof(T));
  }
  return bytes;
}

}  // namespace

TempFolder::TempFolder() {
  static int count = 0;
  path_ = std::filesystem::temp_directory_path() / fmt::format("qtrace_gltf_{}_{}", getpid(), count++);
  std::filesystem::create_directories(path_);
}

TempFolder::~TempFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TempFolder::write(const std::string& name, std::string_view bytes) const {
  const std::filesystem::path file = path_ / name;
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

GltfBuilder::GltfBuilder() {
  json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}};
  json["scenes"] = {{{"nodes", {0}}}};
  json["nodes"] = {{{"name", "eye"}, {"camera", 0}}};
  json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
  json["bufferViews"] = nlohmann::json::array();
  json["accessors"] = nlohmann::json::array();
}

std::size_t GltfBuilder::add_accessor(std::string_view bytes, std::size_t values, const char* type,
                                      int component_type) {
  json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}});
  json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                               {"componentType", component_type},
                               {"count", values / component_count(type)},
                               {"type", type}});
  binary = padded(binary.append(bytes), '\0');
  return json["accessors"].size() - 1;
}

std::size_t GltfBuilder::add_floats(const char* type, const std::vector<float>& components) {
  return add_accessor(components, type, kFloat);
}

std::size_t GltfBuilder::add_indices(const std::vector<std::uint32_t>& indices, int component_type) {
  std::string bytes = narrowed<std::uint32_t>(indices);
  if (component_type == kUnsignedByte) bytes = narrowed<std::uint8_t>(indices);
  if (component_type == kUnsignedShort) bytes = narrowed<std::uint16_t>(indices);
  return add_accessor(bytes, indices.size(), "SCALAR", component_type);
}

std::size_t GltfBuilder::add_texture(const std::string& image, const std::string& media_type) {
  json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", image.size()}});
  binary = padded(binary.append(image), '\0');
  json["images"].push_back({{"bufferView", json["bufferViews"].size() - 1}, {"mimeType", media_type}});
  json["textures"].push_back({{"source", json["images"].size() - 1}});
  return json["textures"].size() - 1;
}

nlohmann::json& GltfBuilder::material() {
  if (!json.contains("materials")) json["materials"] = {nlohmann::json::object()};
  primitive_json()["material"] = 0;
  return json["materials"][0];
}

nlohmann::json GltfBuilder::primitive(const std::vector<float>& positions) {
  return {{"attributes", {{"POSITION", add_floats("VEC3", positions)}}}};
}

std::size_t GltfBuilder::add_mesh(nlohmann::json primitives, const std::string& name) {
  nlohmann::json mesh = {{"primitives", std::move(primitives)}};
  if (!name.empty()) mesh["name"] = name;
  json["meshes"].push_back(std::move(mesh));
  return json["meshes"].size() - 1;
}

std::size_t GltfBuilder::add_node(nlohmann::json node) {
  json["nodes"].push_back(std::move(node));
  const std::size_t index = json["nodes"].size() - 1;
  json["scenes"][0]["nodes"].push_back(index);
  return index;
}

void GltfBuilder::add_triangle() {
  const std::size_t mesh = add_mesh({primitive({0, 0, 0, 1, 0, 0, 0, 1, 0})}, "shape");
  add_node({{"name", "thing"}, {"mesh", mesh}});
}

std::string GltfBuilder::glb() const {
  nlohmann::json document = json;
  if (!document.contains("buffers")) document["buffers"] = {{{"byteLength", binary.size()}}};
  const std::string text = padded(document.dump(), ' ');
  std::string bytes = "glTF";
  append_word(bytes, 2);
  append_word(bytes, 12 + 8 + text.size() + 8 + binary.size());
  append_word(bytes, text.size());
  bytes += "JSON" + text;
  append_word(bytes, binary.size());
  return bytes + std::string("BIN\0", 4) + binary;
}

std::string GltfBuilder::gltf_with(const std::string& uri) const {
  nlohmann::json document = json;
  document["buffers"] = {{{"byteLength", binary.size()}, {"uri", uri}}};
  return document.dump();
}

std::string GltfBuilder::data_uri() const {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes = binary;
  while (bytes.size() % 3 != 0) bytes += '\0';  // a buffer may be longer than declared
  std::string uri = "data:application/octet-stream;base64,";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t j = i; j < i + 3; ++j) bits = bits << 8U | static_cast<unsigned char>(bytes[j]);
    for (const unsigned shift : {18U, 12U, 6U, 0U}) uri += kDigits[bits >> shift & 63U];
  }
  return uri;
}

namespace {

// What the loader says of a file that it must refuse.
void expect_refusal(const std::filesystem::path& file, const View& view,
                    std::initializer_list<std::string_view> parts) {
  try {
    load_gltf(file, view);
    ADD_FAILURE() << "the loader accepts " << file;
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find(file.string()), 0U) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string_view part : parts) {
      EXPECT_NE(message.find(part), std::string::npos) << message << "\nlacks: " << part;
    }
  }
}

}  // namespace

Scene GltfTest::load() const { return load(View()); }

Scene GltfTest::load(const View& view) const {
  return load_gltf(folder.write("scene.glb", gltf.glb()), view);
}

Scene GltfTest::load(const std::string& name, std::string_view bytes) const {
  return load_gltf(folder.write(name, bytes));
}

void GltfTest::expect_error(std::initializer_list<std::string_view> parts) const {
  expect_error(View(), parts);
}

void GltfTest::expect_error(const View& view, std::initializer_list<std::string_view> parts) const {
  expect_refusal(folder.write("scene.glb", gltf.glb()), view, parts);
}

void GltfTest::expect_error(const std::filesystem::path& file,
                            std::initializer_list<std::string_view> parts) const {
  expect_refusal(file, {}, parts);
}

void GltfTest::expect_warning(std::string_view warning) const {
  const Scene scene = load();
  ASSERT_EQ(scene.warnings.size(), 1U) << ::testing::PrintToString(scene.warnings);
  EXPECT_EQ(scene.warnings[0], warning);
}

}  // namespace qtrace
