#include "engine/gltf_document/draco.h"

#include "engine/gltf_document/expansion.h"

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>

#include <cstdint>
#include <cstring>
#include <memory>

namespace qtrace::gltf {
namespace {

using nlohmann::json;

constexpr const char* kExtension = "KHR_draco_mesh_compression";

std::unique_ptr<draco::Mesh> decoded(const Source& source, const std::string& place,
                                     std::span<const unsigned char> bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
  source.check(mesh.ok(), "{}: its {} bytes cannot be decoded: {}", place, bytes.size(),
               mesh.ok() ? "" : mesh.status().error_msg_string());
  return std::move(mesh).value();
}

template <class T>
void append_values(const draco::PointAttribute& attribute, std::size_t points, std::int8_t components,
                   std::vector<unsigned char>& bytes) {
  std::vector<T> value(static_cast<std::size_t>(components));
  for (std::size_t i = 0; i < points; ++i) {
    attribute.ConvertValue<T>(attribute.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(i))),
                              components, value.data());
    const auto* first = reinterpret_cast<const unsigned char*>(value.data());
    bytes.insert(bytes.end(), first, first + value.size() * sizeof(T));
  }
}

class Primitives {
 public:
  Primitives(const Source& source, json& document, std::vector<tinygltf::Buffer>& buffers,
             std::size_t max_bytes)
      : source_(source), document_(document), buffers_(buffers), max_bytes_(max_bytes), rest_(max_bytes) {}

  void decode(json& primitive, const std::string& place) {
    const json extension = primitive["extensions"][kExtension];
    place_ = place;
    source_.check(primitive.value("mode", TINYGLTF_MODE_TRIANGLES) == TINYGLTF_MODE_TRIANGLES,
                  "{} is compressed with {} and has mode {}; 4, triangles, would be right", place_,
                  kExtension, primitive.value("mode", 0));
    const auto view = extension.at("bufferView").get<std::size_t>();
    const auto mesh = decoded(source_, fmt::format("{} {}", place_, kExtension),
                              view_bytes(source_, document_, buffers_, view));
    set_indices(primitive, *mesh);
    for (const auto& [name, id] : extension.at("attributes").items())
      set_attribute(primitive, name, id, *mesh);
    primitive["extensions"].erase(kExtension);
  }

 private:
  // Accessors that other primitives may share stay as they are.
  std::size_t add_accessor(json accessor, std::size_t count, std::vector<unsigned char> bytes) {
    source_.check(bytes.size() <= rest_,
                  "{}: what is compressed with {} has more than {} bytes, which is the most supported",
                  place_, kExtension, max_bytes_);
    rest_ -= bytes.size();
    for (const char* member : {"byteOffset", "sparse"}) accessor.erase(member);
    accessor["count"] = count;
    accessor["bufferView"] = add_view(document_, buffers_, std::move(bytes));
    document_["accessors"].push_back(std::move(accessor));
    return document_["accessors"].size() - 1;
  }

  void set_indices(json& primitive, const draco::Mesh& mesh) {
    std::vector<unsigned char> bytes;
    for (std::uint32_t face = 0; face < mesh.num_faces(); ++face) {
      for (const draco::PointIndex& point : mesh.face(draco::FaceIndex(face))) {
        const std::uint32_t value = point.value();
        const auto* first = reinterpret_cast<const unsigned char*>(&value);
        bytes.insert(bytes.end(), first, first + sizeof(value));
      }
    }
    const json accessor{{"componentType", TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT}, {"type", "SCALAR"}};
    primitive["indices"] = add_accessor(accessor, std::size_t{3} * mesh.num_faces(), std::move(bytes));
  }

  void set_attribute(json& primitive, const std::string& name, const json& id, const draco::Mesh& mesh) {
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id.get<std::uint32_t>());
    source_.check(attribute != nullptr, "{} {}: {} is attribute {}, which the compressed data does not have",
                  place_, kExtension, name, id.dump());
    source_.check(primitive["attributes"].contains(name),
                  "{}: {} is compressed with {} and no attribute of the primitive", place_, name, kExtension);
    const json accessor = document_["accessors"][primitive["attributes"][name].get<std::size_t>()];
    const auto type = accessor.at("type").get<std::string>();
    const auto components = static_cast<std::int8_t>(type.starts_with("VEC") ? type.back() - '0' : 1);
    source_.check(!type.starts_with("MAT"), "{} {} is a {}, which {} does not have", place_, name, type,
                  kExtension);
    primitive["attributes"][name] = add_accessor(
        accessor, mesh.num_points(),
        values(*attribute, mesh.num_points(), components, accessor.at("componentType").get<int>()));
  }

  static std::vector<unsigned char> values(const draco::PointAttribute& attribute, std::size_t points,
                                           std::int8_t components, int component_type) {
    std::vector<unsigned char> bytes;
    switch (component_type) {
      case TINYGLTF_COMPONENT_TYPE_BYTE:
        append_values<std::int8_t>(attribute, points, components, bytes);
        break;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        append_values<std::uint8_t>(attribute, points, components, bytes);
        break;
      case TINYGLTF_COMPONENT_TYPE_SHORT:
        append_values<std::int16_t>(attribute, points, components, bytes);
        break;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        append_values<std::uint16_t>(attribute, points, components, bytes);
        break;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        append_values<std::uint32_t>(attribute, points, components, bytes);
        break;
      default:
        append_values<float>(attribute, points, components, bytes);
    }
    return bytes;
  }

  const Source& source_;
  json& document_;
  std::vector<tinygltf::Buffer>& buffers_;
  std::size_t max_bytes_, rest_;
  std::string place_;
};

bool is_compressed(const json& primitive) {
  const auto extensions = primitive.find("extensions");
  return extensions != primitive.end() && extensions->is_object() && extensions->contains(kExtension);
}

}  // namespace

void decode_draco(const Source& source, json& document, std::vector<tinygltf::Buffer>& buffers,
                  std::size_t max_bytes) {
  const auto meshes = document.find("meshes");
  if (meshes == document.end()) return;
  Primitives primitives(source, document, buffers, max_bytes);
  for (std::size_t i = 0; i < meshes->size(); ++i) {
    json& mesh = (*meshes)[i];
    if (!mesh.contains("primitives")) continue;
    for (std::size_t k = 0; k < mesh["primitives"].size(); ++k) {
      json& primitive = mesh["primitives"][k];
      if (!is_compressed(primitive)) continue;
      primitives.decode(primitive,
                        fmt::format("{} primitive {}", label("mesh", i, mesh.value("name", "")), k));
    }
  }
}

}  // namespace qtrace::gltf
