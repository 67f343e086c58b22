// Which properties of the glTF JSON are checked, and for what.
#pragma once

#include <cstddef>
#include <string_view>

namespace qtrace::gltf {

enum class Kind { string, boolean, integer, stride, number, numbers, one_of, index };

struct Rule {
  // Segments between '/': [] is every element of an array, {} every member of an object, and a name with
  // '!' must be there.
  std::string_view path;
  Kind kind;
  std::string_view words = {};  // one_of: the values; index: the array it points into, by its path
  std::size_t length = 0;       // numbers
};

inline constexpr std::string_view kComponentTypes = "5120 5121 5122 5123 5125 5126";
inline constexpr std::string_view kTypes = "SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4";
inline constexpr std::string_view kWraps = "10497 33071 33648";

inline constexpr Rule kRules[] = {
    {"scene", Kind::index, "scenes"},
    {"scenes/[]/name", Kind::string},
    {"scenes/[]/nodes/[]", Kind::index, "nodes"},
    {"nodes/[]/name", Kind::string},
    {"nodes/[]/children/[]", Kind::index, "nodes"},
    {"nodes/[]/mesh", Kind::index, "meshes"},
    {"nodes/[]/camera", Kind::index, "cameras"},
    {"nodes/[]/skin", Kind::index, "skins"},
    {"nodes/[]/matrix", Kind::numbers, {}, 16},
    {"nodes/[]/translation", Kind::numbers, {}, 3},
    {"nodes/[]/rotation", Kind::numbers, {}, 4},
    {"nodes/[]/scale", Kind::numbers, {}, 3},
    {"nodes/[]/weights/[]", Kind::number},
    {"nodes/[]/extensions/KHR_node_visibility/visible", Kind::boolean},
    {"nodes/[]/extensions/EXT_mesh_gpu_instancing/attributes!/{}", Kind::index, "accessors"},
    {"meshes/[]/name", Kind::string},
    {"meshes/[]/weights/[]", Kind::number},
    {"meshes/[]/primitives/[]/extensions/KHR_draco_mesh_compression/bufferView!", Kind::index, "bufferViews"},
    {"meshes/[]/primitives/[]/extensions/KHR_draco_mesh_compression/attributes!/{}", Kind::integer},
    {"meshes/[]/primitives/[]/attributes!/{}", Kind::index, "accessors"},
    {"meshes/[]/primitives/[]/indices", Kind::index, "accessors"},
    {"meshes/[]/primitives/[]/material", Kind::index, "materials"},
    {"meshes/[]/primitives/[]/mode", Kind::one_of, "0 1 2 3 4 5 6"},
    {"meshes/[]/primitives/[]/targets/[]/{}", Kind::index, "accessors"},
    {"accessors/[]/bufferView", Kind::index, "bufferViews"},
    {"accessors/[]/byteOffset", Kind::integer},
    {"accessors/[]/componentType!", Kind::one_of, kComponentTypes},
    {"accessors/[]/count!", Kind::integer},
    {"accessors/[]/type!", Kind::one_of, kTypes},
    {"accessors/[]/normalized", Kind::boolean},
    {"accessors/[]/sparse/count!", Kind::integer},
    {"accessors/[]/sparse/indices!/bufferView!", Kind::index, "bufferViews"},
    {"accessors/[]/sparse/indices/componentType!", Kind::one_of, "5121 5123 5125"},
    {"accessors/[]/sparse/indices/byteOffset", Kind::integer},
    {"accessors/[]/sparse/values!/bufferView!", Kind::index, "bufferViews"},
    {"accessors/[]/sparse/values/byteOffset", Kind::integer},
    {"bufferViews/[]/buffer!", Kind::index, "buffers"},
    {"bufferViews/[]/byteOffset", Kind::integer},
    {"bufferViews/[]/byteLength!", Kind::integer},
    {"bufferViews/[]/byteStride", Kind::stride},
    {"bufferViews/[]/extensions/EXT_meshopt_compression/buffer!", Kind::index, "buffers"},
    {"bufferViews/[]/extensions/EXT_meshopt_compression/byteOffset", Kind::integer},
    {"bufferViews/[]/extensions/EXT_meshopt_compression/byteLength!", Kind::integer},
    {"bufferViews/[]/extensions/EXT_meshopt_compression/byteStride!", Kind::integer},
    {"bufferViews/[]/extensions/EXT_meshopt_compression/count!", Kind::integer},
    {"bufferViews/[]/extensions/EXT_meshopt_compression/mode!", Kind::one_of, "ATTRIBUTES TRIANGLES INDICES"},
    {"bufferViews/[]/extensions/EXT_meshopt_compression/filter", Kind::one_of,
     "NONE OCTAHEDRAL QUATERNION EXPONENTIAL"},
    {"bufferViews/[]/extensions/KHR_meshopt_compression/buffer!", Kind::index, "buffers"},
    {"bufferViews/[]/extensions/KHR_meshopt_compression/byteOffset", Kind::integer},
    {"bufferViews/[]/extensions/KHR_meshopt_compression/byteLength!", Kind::integer},
    {"bufferViews/[]/extensions/KHR_meshopt_compression/byteStride!", Kind::integer},
    {"bufferViews/[]/extensions/KHR_meshopt_compression/count!", Kind::integer},
    {"bufferViews/[]/extensions/KHR_meshopt_compression/mode!", Kind::one_of, "ATTRIBUTES TRIANGLES INDICES"},
    {"bufferViews/[]/extensions/KHR_meshopt_compression/filter", Kind::one_of,
     "NONE OCTAHEDRAL QUATERNION EXPONENTIAL COLOR"},
    {"buffers/[]/byteLength!", Kind::integer},
    {"buffers/[]/uri", Kind::string},
    {"materials/[]/name", Kind::string},
    {"materials/[]/pbrMetallicRoughness/baseColorFactor", Kind::numbers, {}, 4},
    {"materials/[]/pbrMetallicRoughness/metallicFactor", Kind::number},
    {"materials/[]/pbrMetallicRoughness/roughnessFactor", Kind::number},
    {"materials/[]/emissiveFactor", Kind::numbers, {}, 3},
    {"materials/[]/alphaMode", Kind::one_of, "OPAQUE MASK BLEND"},
    {"materials/[]/alphaCutoff", Kind::number},
    {"materials/[]/doubleSided", Kind::boolean},
    {"materials/[]/extensions/KHR_materials_emissive_strength/emissiveStrength", Kind::number},
    {"materials/[]/extensions/KHR_materials_specular/specularFactor", Kind::number},
    {"materials/[]/extensions/KHR_materials_specular/specularColorFactor", Kind::numbers, {}, 3},
    {"materials/[]/extensions/KHR_materials_ior/ior", Kind::number},
    {"materials/[]/extensions/KHR_materials_transmission/transmissionFactor", Kind::number},
    {"materials/[]/extensions/KHR_materials_volume/thicknessFactor", Kind::number},
    {"materials/[]/extensions/KHR_materials_volume/attenuationDistance", Kind::number},
    {"materials/[]/extensions/KHR_materials_volume/attenuationColor", Kind::numbers, {}, 3},
    {"materials/[]/extensions/KHR_materials_clearcoat/clearcoatFactor", Kind::number},
    {"materials/[]/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", Kind::number},
    {"cameras/[]/name", Kind::string},
    {"cameras/[]/type!", Kind::one_of, "perspective orthographic"},
    {"cameras/[]/perspective/yfov!", Kind::number},
    {"cameras/[]/perspective/znear!", Kind::number},
    {"cameras/[]/perspective/zfar", Kind::number},
    {"cameras/[]/perspective/aspectRatio", Kind::number},
    {"cameras/[]/orthographic/xmag!", Kind::number},
    {"cameras/[]/orthographic/ymag!", Kind::number},
    {"cameras/[]/orthographic/znear!", Kind::number},
    {"cameras/[]/orthographic/zfar!", Kind::number},
    {"textures/[]/source", Kind::index, "images"},
    {"textures/[]/sampler", Kind::index, "samplers"},
    {"samplers/[]/magFilter", Kind::one_of, "9728 9729"},
    {"samplers/[]/wrapS", Kind::one_of, kWraps},
    {"samplers/[]/wrapT", Kind::one_of, kWraps},
    {"images/[]/name", Kind::string},
    {"images/[]/uri", Kind::string},
    {"images/[]/mimeType", Kind::string},
    {"images/[]/bufferView", Kind::index, "bufferViews"},
    {"skins/[]/name", Kind::string},
    {"skins/[]/joints!/[]", Kind::index, "nodes"},
    {"skins/[]/skeleton", Kind::index, "nodes"},
    {"skins/[]/inverseBindMatrices", Kind::index, "accessors"},
    {"animations/[]/name", Kind::string},
    {"animations/[]/channels/[]/target/node", Kind::index, "nodes"},
    {"animations/[]/samplers/[]/input", Kind::index, "accessors"},
    {"animations/[]/samplers/[]/output", Kind::index, "accessors"},
    {"nodes/[]/extensions/KHR_lights_punctual/light!", Kind::index, "extensions/KHR_lights_punctual/lights"},
    {"extensions/KHR_lights_punctual/lights/[]/name", Kind::string},
    {"extensions/KHR_lights_punctual/lights/[]/type!", Kind::one_of, "point spot directional"},
    {"extensions/KHR_lights_punctual/lights/[]/color", Kind::numbers, {}, 3},
    {"extensions/KHR_lights_punctual/lights/[]/intensity", Kind::number},
    {"extensions/KHR_lights_punctual/lights/[]/range", Kind::number},
    {"extensions/KHR_lights_punctual/lights/[]/spot/innerConeAngle", Kind::number},
    {"extensions/KHR_lights_punctual/lights/[]/spot/outerConeAngle", Kind::number},
    {"extensionsUsed/[]", Kind::string},
    {"extensionsRequired/[]", Kind::string},
};

// Where materials name textures. kTextureRules hold at each of them.
inline constexpr std::string_view kTexturePlaces[] = {
    "materials/[]/pbrMetallicRoughness/baseColorTexture",
    "materials/[]/pbrMetallicRoughness/metallicRoughnessTexture",
    "materials/[]/normalTexture",
    "materials/[]/occlusionTexture",
    "materials/[]/emissiveTexture",
    "materials/[]/extensions/KHR_materials_specular/specularTexture",
    "materials/[]/extensions/KHR_materials_specular/specularColorTexture",
    "materials/[]/extensions/KHR_materials_transmission/transmissionTexture",
    "materials/[]/extensions/KHR_materials_volume/thicknessTexture",
    "materials/[]/extensions/KHR_materials_clearcoat/clearcoatTexture",
    "materials/[]/extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture",
    "materials/[]/extensions/KHR_materials_clearcoat/clearcoatNormalTexture",
};

inline constexpr Rule kTextureRules[] = {
    {"index!", Kind::index, "textures"},
    {"texCoord", Kind::integer},
    {"scale", Kind::number},
    {"extensions/KHR_texture_transform/offset", Kind::numbers, {}, 2},
    {"extensions/KHR_texture_transform/rotation", Kind::number},
    {"extensions/KHR_texture_transform/scale", Kind::numbers, {}, 2},
    {"extensions/KHR_texture_transform/texCoord", Kind::integer},
};

}  // namespace qtrace::gltf
