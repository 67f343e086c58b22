#include "tests/system/small_scene.h"

#include <fmt/format.h>

#include <array>
#include <vector>

namespace qtrace::tests {
namespace {

using Point = std::array<float, 3>;

// Two triangles, counter-clockwise from the side that they face.
std::array<Point, 6> quad(Point a, Point b, Point c, Point d) { return {a, b, c, a, c, d}; }

constexpr const char* kScene = R"({{
  "asset": {{"version": "2.0"}},
  "scene": 0,
  "scenes": [{{"nodes": [0, 1, 2]}}],
  "nodes": [{{"camera": 0, "translation": [0, 1, 3]}}, {{"mesh": 0, "name": "floor"}}, {{"mesh": 1, "name": "panel"}}],
  "cameras": [{{"type": "perspective", "perspective": {{"yfov": 1.2, "znear": 0.1}}}}],
  "materials": [
    {{"pbrMetallicRoughness": {{"baseColorFactor": [0.8, 0.6, 0.4, 1], "metallicFactor": 0}}}},
    {{"emissiveFactor": [{0}, {0}, {0}], "pbrMetallicRoughness": {{"metallicFactor": 0}}}}
  ],
  "meshes": [
    {{"primitives": [{{"attributes": {{"POSITION": 0}}, "material": 0}}]}},
    {{"primitives": [{{"attributes": {{"POSITION": 1}}, "material": 1}}]}}
  ],
  "accessors": [
    {{"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3", "min": [-2, 0, -2], "max": [2, 0, 2]}},
    {{"bufferView": 1, "componentType": 5126, "count": 6, "type": "VEC3", "min": [-1, 2, -1], "max": [1, 2, 1]}}
  ],
  "bufferViews": [{{"buffer": 0, "byteLength": 72}}, {{"buffer": 0, "byteOffset": 72, "byteLength": 72}}],
  "buffers": [{{"uri": "{1}.bin", "byteLength": 144}}]
}})";

}  // namespace

void write_small_scene(const TempFolder& folder, const std::string& name, Light light) {
  const auto floor = quad({-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2});
  const auto panel = quad({-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1});
  std::string bytes(reinterpret_cast<const char*>(floor.data()), sizeof(floor));
  bytes.append(reinterpret_cast<const char*>(panel.data()), sizeof(panel));
  folder.write(name + ".bin", bytes);
  folder.write(name + ".gltf", fmt::format(kScene, light == Light::on ? 1 : 0, name));
}

std::string small_config(const std::string& name, const std::string& extra) {
  return fmt::format(R"({{"name": "{}", {}"scene": "scene.gltf", "width": 8, "height": 8, "frames": 4,
                          "max_bounces": 3, "reference": {{"frames": 8}}}})",
                     name, extra);
}

}  // namespace qtrace::tests
