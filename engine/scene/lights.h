// Lights that no surface has.
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace qtrace {

// KHR_lights_punctual. No ray meets them. Radiance is in nits (candela per square metre), as emission is.
struct PunctualLight {
  enum class Kind : std::uint8_t { point, spot, directional };

  std::string name;
  Kind kind = Kind::point;
  glm::vec3 position{0.0F};  // in the world; of point and spot
  glm::vec3 direction{0.0F, 0.0F,
                      -1.0F};  // unit, in the world, along which it shines; of spot and directional
  glm::vec3 intensity{1.0F};   // colour times candela for point and spot, times lux for directional
  float range = std::numeric_limits<float>::infinity();  // of point and spot: beyond it there is no light
  float inner_cone_angle = 0.0F;                         // radians, of spot: full intensity up to here
  float outer_cone_angle = 0.785398163F;                 // radians: none from here on
};

// Radiance from all directions outside of the scene, in latitude and longitude: rows from the top (+y), the
// middle of the image towards -z, its right half towards +x. Bilinear between centres of texels, around the
// seam as well; beyond the first and last row's centres, those rows.
struct EnvironmentMap {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<glm::vec3> radiance;
  float rotation =
      0.0F;  // radians about +y, by the right hand: the middle of the image turns from -z towards -x

  bool operator==(const EnvironmentMap&) const = default;
};

}  // namespace qtrace
