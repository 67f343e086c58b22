// What becomes of every property and extension of glTF 2.0: docs/gltf.md is this table.
#pragma once

#include <array>
#include <string_view>

namespace qtrace::gltf {

enum class Treatment {
  read,          // the picture has it
  approximated,  // something simpler stands for it, and a warning says so
  warned,        // it is left out, and a warning says so
  refused,       // the file cannot be read truly without it
  unseen,        // no picture of this tracer could show it
};

constexpr std::string_view treatment_name(Treatment treatment) {
  constexpr std::array<std::string_view, 5> kNames{
      "read", "approximated, with a warning", "left out, with a warning", "refused", "makes no difference"};
  return kNames[static_cast<std::size_t>(treatment)];
}

// An extension, or a property by its path; several that belong together are one row.
struct Support {
  std::string_view name;
  Treatment treatment;
  std::string_view note;
};

inline constexpr std::string_view kOtherImage =
    "the texture's PNG or JPEG in its place; refused where a material reads a texture that has none";

inline constexpr Support kSupport[] = {
    {"asset.version", Treatment::read, "2.0 and later 2.x"},
    {"asset.minVersion", Treatment::refused, "other than 2.0"},
    {"scene, scenes", Treatment::read, "the default scene, else the first; key `gltf_scene` chooses another"},
    {"nodes: matrix, translation, rotation, scale", Treatment::read, "mirrored ones, too"},
    {"nodes: camera", Treatment::read, "the first; key `camera` chooses another, or a place"},
    {"nodes: skin", Treatment::read, "in the pose of its joints"},
    {"nodes: weights, meshes: weights, targets", Treatment::read, "POSITION, NORMAL and TANGENT"},
    {"primitives: POSITION, NORMAL, indices, mode 4 to 6", Treatment::read, "triangles, strips and fans"},
    {"primitives: mode 0 to 3", Treatment::warned, "points and lines; primitives without POSITION as well"},
    {"primitives: TEXCOORD_0", Treatment::read,
     "for textures, and for sites that are placed by it (`rl.site_placement`)"},
    {"primitives: TEXCOORD_1", Treatment::read,
     "for textures; further sets are refused where one reads them"},
    {"primitives: TANGENT", Treatment::read,
     "for textures of normals; without it tangents follow from the texture coordinates"},
    {"primitives: COLOR_0", Treatment::read, "outside of 0 to 1 clamped, with a warning"},
    {"accessors: sparse, without a bufferView", Treatment::read, ""},
    {"buffers: uri", Treatment::read,
     "data URIs, and files in the scene's folder; those that serve nothing are not read"},
    {"materials: baseColorFactor, metallicFactor, roughnessFactor", Treatment::read, ""},
    {"materials: emissiveFactor", Treatment::read,
     "above 1 with a warning; with emissiveStrength up to 1e12"},
    {"materials: baseColorTexture, metallicRoughnessTexture, normalTexture, emissiveTexture", Treatment::read,
     "one without an image with a warning"},
    {"materials: occlusionTexture", Treatment::unseen, "light that is traced finds out what is occluded"},
    {"textures: source, sampler", Treatment::read, "wrapS, wrapT, magFilter"},
    {"samplers: minFilter", Treatment::unseen, "there are as many samples of a texture as of a pixel"},
    {"images", Treatment::read,
     "PNG and JPEG in files of the scene's folder, data URIs and bufferViews, of up to 32768 texels a side "
     "and 2^27 in all, whatever they say of colour spaces; broken ones are refused where a material reads "
     "them"},
    {"materials: alphaMode, alphaCutoff", Treatment::read, "OPAQUE, MASK and BLEND"},
    {"materials: doubleSided", Treatment::read,
     "emission leaves both faces; surfaces reflect on both anyway"},
    {"cameras: perspective, orthographic", Treatment::read,
     "aspectRatio, znear and zfar with a warning where the picture differs from them; refused under a node "
     "that mirrors"},
    {"animations", Treatment::warned, "nodes keep their own transforms"},
    {"extras", Treatment::unseen, ""},
    {"extensionsRequired", Treatment::refused, "where it names an extension that would be left out"},
    {"overlapping surfaces in one plane", Treatment::approximated,
     "the one that emits is seen there, else the one that lies on the other; the sides of a card are moved "
     "apart; refused where two lamps differ"},
    {"EXT_mesh_gpu_instancing", Treatment::read,
     "TRANSLATION, ROTATION, SCALE; of a skinned mesh with a warning"},
    {"EXT_meshopt_compression", Treatment::read, ""},
    {"EXT_texture_avif", Treatment::approximated, kOtherImage},
    {"EXT_texture_webp", Treatment::approximated, kOtherImage},
    {"KHR_draco_mesh_compression", Treatment::read, "triangles"},
    {"KHR_lights_punctual", Treatment::read, "point, spot and directional"},
    {"KHR_materials_clearcoat", Treatment::read, "with its textures"},
    {"KHR_materials_emissive_strength", Treatment::read, ""},
    {"KHR_materials_ior", Treatment::read, "1 or more, or 0"},
    {"KHR_materials_specular", Treatment::read, "with its textures"},
    {"KHR_materials_transmission", Treatment::read, "with its texture"},
    {"KHR_materials_unlit", Treatment::read, ""},
    {"KHR_materials_variants", Treatment::unseen, "each mesh has the material that it comes with"},
    {"KHR_materials_volume", Treatment::read,
     "attenuation; paths find out how thick it is, so that thicknessTexture makes no difference"},
    {"KHR_mesh_quantization", Treatment::read, ""},
    {"KHR_meshopt_compression", Treatment::read, "as far as the installed meshoptimizer decodes it"},
    {"KHR_node_visibility", Treatment::read, ""},
    {"KHR_texture_basisu", Treatment::approximated, kOtherImage},
    {"KHR_texture_transform", Treatment::read, "offset, rotation, scale, texCoord"},
    {"KHR_xmp_json_ld", Treatment::unseen, "says who made the file"},
    {"any other extension", Treatment::warned, "refused where a file requires it"},
};

// Of an extension. One that no row names is left out.
constexpr Treatment treatment_of(std::string_view extension) {
  for (const Support& row : kSupport) {
    if (row.name == extension) return row.treatment;
  }
  return Treatment::warned;
}

// The format has files refused that require what would be left out.
constexpr bool may_be_required(Treatment treatment) {
  return treatment != Treatment::warned && treatment != Treatment::refused;
}

constexpr bool shows_in_full(Treatment treatment) {
  return treatment == Treatment::read || treatment == Treatment::unseen;
}

}  // namespace qtrace::gltf
