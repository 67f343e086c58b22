#pragma once

#include "engine/scene/analytic.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <random>
#include <vector>

namespace qtrace::test {

// A closed surface with corners at random distances from its middle, 40 around and 21 from pole to pole.
inline Scene bumpy_ball(glm::vec3 middle) {
  constexpr int kAround = 40;
  constexpr int kRows = 20;
  std::mt19937 random(11);
  std::uniform_real_distribution<float> radius(0.7F, 1.0F);
  std::vector<std::vector<glm::vec3>> rows;
  for (int row = 0; row <= kRows; ++row) {
    const float polar = 3.14159265F * static_cast<float>(row) / kRows;
    std::vector<glm::vec3>& points = rows.emplace_back();
    for (int i = 0; i < kAround; ++i) {
      const float azimuth = 2 * 3.14159265F * static_cast<float>(i) / kAround;
      const glm::vec3 unit(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                           std::sin(polar) * std::sin(azimuth));
      const bool is_pole = row == 0 || row == kRows;
      points.push_back(is_pole && i > 0 ? points[0] : middle + radius(random) * unit);
    }
  }
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.5F))};
  const auto add = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    if (a == b || b == c || c == a) return;
    const glm::vec3 n(glm::normalize(area_vector({a, b, c})));
    scene.triangles.push_back({{a, b, c}, {n, n, n}, {}, 0, 0});
  };
  for (int row = 0; row < kRows; ++row) {
    for (int i = 0; i < kAround; ++i) {
      const auto r = static_cast<std::size_t>(row);
      const auto here = static_cast<std::size_t>(i);
      const auto next = static_cast<std::size_t>((i + 1) % kAround);
      add(rows[r][here], rows[r][next], rows[r + 1][next]);
      add(rows[r][here], rows[r + 1][next], rows[r + 1][here]);
    }
  }
  scene.objects = {{"ball", 0, static_cast<std::uint32_t>(scene.triangles.size()), false}};
  return scene;
}

}  // namespace qtrace::test
