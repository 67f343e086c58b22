// Feeds bytes to the glTF loader: .glb where they begin as one, else .gltf.
#include "engine/core/check.h"
#include "engine/gltf/load_gltf.h"
#include "engine/gltf_document/file.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/json_mutator.h"

#include <algorithm>
#include <cmath>

namespace qtrace::fuzz {
namespace {

// Buffers in files cannot be found in a folder that is not there.
const char* const kFile = "/nonexistent/folder/fuzz.gltf";

// What the sanitizers can read in a second.
const SceneLimits kLimits{std::size_t{1} << 16U, std::size_t{1} << 13U, std::size_t{1} << 24U,
                          std::size_t{1} << 24U, std::size_t{1} << 16U};

bool is_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool has_normals(const Material& material) {
  return material.texture(TextureSlot::normal) || material.texture(TextureSlot::clearcoat_normal);
}

void expect_usable_attributes(const Scene& scene) {
  for (const Triangle& triangle : scene.triangles) {
    const bool needs_tangents = has_normals(scene.materials[triangle.material]);
    if (triangle.attributes == kNoAttributes) {
      expect(!needs_tangents, "a triangle with a texture of normals must have tangents", "none");
      continue;
    }
    expect(triangle.attributes < scene.attributes.size(), "indices must stay inside their arrays",
           "attributes");
    const TriangleAttributes& attributes = scene.attributes[triangle.attributes];
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::vec4 &tangent = attributes.tangent[i], &color = attributes.color[i];
      expect(std::isfinite(attributes.uv1[i].x) && std::isfinite(attributes.uv1[i].y),
             "coordinates must be finite", "they are not");
      for (int c = 0; c < 4; ++c)
        expect(color[c] >= 0 && color[c] <= 1.0001F, "colours must be from 0 to 1", std::to_string(color[c]));
      const bool is_unit = std::abs(glm::length(glm::vec3(tangent)) - 1) < 1e-3 && std::abs(tangent.w) == 1;
      expect(!needs_tangents || is_unit, "tangents must have length 1",
             std::to_string(glm::length(glm::vec3(tangent))));
    }
  }
}

void expect_usable(const Scene& scene) {
  for (const std::string& warning : scene.warnings) expect_message(warning);
  expect(scene.triangles.empty() == scene.objects.empty(), "objects must have triangles", "none");
  for (const Triangle& triangle : scene.triangles) {
    const bool is_inside =
        triangle.material < scene.materials.size() && triangle.object < scene.objects.size();
    expect(is_inside, "indices must stay inside their arrays", "a triangle's");
    for (std::size_t i = 0; i < 3; ++i) {
      const bool finite = is_finite(triangle.position[i]) && std::isfinite(triangle.uv[i].x) &&
                          std::isfinite(triangle.uv[i].y);
      expect(finite, "positions and texture coordinates must be finite", "they are not");
      expect(std::abs(glm::length(triangle.normal[i]) - 1) < 1e-3, "normals must have length 1",
             std::to_string(glm::length(triangle.normal[i])));
    }
  }
  expect_usable_attributes(scene);
  std::size_t next = 0;
  for (const Object& object : scene.objects) {
    expect(object.first_triangle == next && object.triangle_count > 0, "objects must follow each other",
           object.name);
    next += object.triangle_count;
  }
  expect(next == scene.triangles.size(), "objects must cover all triangles", std::to_string(next));
  for (const Material& material : scene.materials) {
    expect(is_finite(material.emission) && is_finite(material.specular_color), "materials must be finite",
           material.name);
    for (const auto& texture : material.textures) {
      expect(!texture || (texture->image < scene.images.size() && texture->uv_set <= 1),
             "textures must have an image", material.name);
    }
  }
  for (const PunctualLight& light : scene.lights) {
    expect(is_finite(light.position) && is_finite(light.intensity) && light.range > 0,
           "lights must be finite", light.name);
    expect(std::abs(glm::length(light.direction) - 1) < 1e-3, "directions must have length 1", light.name);
  }
}

std::string word(std::size_t value) {
  std::string bytes;
  for (unsigned shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xffU);
  return bytes;
}

// With lengths that fit, which changes of bytes alone would break.
std::string glb(const gltf::FileContent& content) {
  const std::string binary(content.binary.begin(), content.binary.end());
  const std::string chunks =
      word(content.json.size()) + "JSON" + content.json +
      (content.has_binary ? word(binary.size()) + std::string("BIN\0", 4) + binary : "");
  return "glTF" + word(2) + word(12 + chunks.size()) + chunks;
}

std::string mutate_glb(gltf::FileContent content, std::size_t max_size, unsigned seed) {
  if (seed % 4 == 0 && content.has_binary) {
    const std::string binary(content.binary.begin(), content.binary.end());
    const std::string changed = mutate_bytes(binary, std::min(max_size, binary.size() + 64));
    content.binary.assign(changed.begin(), changed.end());
    return glb(content);
  }
  const std::string changed = seed % 4 == 1 ? "" : mutate_json(content.json, seed / 4);
  content.json =
      changed.empty() ? mutate_bytes(content.json, std::min(max_size, content.json.size() + 64)) : changed;
  return glb(content);
}

std::string mutate(std::string_view bytes, std::size_t max_size, unsigned seed) {
  if (seed % 8 == 0) return mutate_bytes(bytes, max_size);
  try {
    const std::vector<unsigned char> copy(bytes.begin(), bytes.end());
    gltf::FileContent content = gltf::split_content(copy, kFile);
    if (bytes.starts_with("glTF")) return mutate_glb(std::move(content), max_size, seed / 8);
    const std::string changed = seed / 8 % 2 == 0 ? mutate_json(content.json, seed / 16) : "";
    if (!changed.empty()) return changed;
  } catch (const Error&) {
    // A broken container: bytes are all that can be changed.
  }
  return mutate_bytes(bytes, max_size);
}

}  // namespace
}  // namespace qtrace::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace qtrace;
  View view;  // a camera of the file, or one that is put where everything is seen
  if (size % 2 == 0) view.camera.kind = CameraChoice::Kind::fit;
  try {
    fuzz::expect_usable(parse_gltf({data, size}, fuzz::kFile, view, fuzz::kLimits));
  } catch (const Error& error) {
    fuzz::expect_message(error.what());
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  using namespace qtrace::fuzz;
  return store(mutate(as_text(data, size), max_size, seed), data, max_size);
}
