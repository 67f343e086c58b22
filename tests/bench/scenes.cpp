#include "tests/bench/scenes.h"

#include "engine/core/check.h"
#include "engine/scene/analytic.h"
#include "engine/gltf/load_gltf.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string_view>

namespace qtrace::bench {
namespace {

constexpr std::uint32_t kMostBalls = 64;  // four along each axis
constexpr std::uint32_t kBallsPerSide = 4;
constexpr std::uint32_t kLeastOfBall = 64;  // triangles, where there are many balls
constexpr float kHalf = 5;                  // of the room

void add_walls(Scene& scene) {
  constexpr std::uint32_t kWhite = 0;
  constexpr std::uint32_t kRed = 1;
  constexpr std::uint32_t kLight = 2;
  const float h = kHalf;
  const float d = 2 * kHalf;
  add_quad(scene, {-h, -h, h}, {d, 0, 0}, {0, 0, -d}, kWhite);  // floor
  add_quad(scene, {-h, h, -h}, {d, 0, 0}, {0, 0, d}, kWhite);   // ceiling
  add_quad(scene, {-h, -h, -h}, {d, 0, 0}, {0, d, 0}, kWhite);  // back
  add_quad(scene, {h, -h, h}, {-d, 0, 0}, {0, d, 0}, kWhite);   // front
  add_quad(scene, {-h, -h, h}, {0, 0, -d}, {0, d, 0}, kRed);    // left
  add_quad(scene, {h, -h, -h}, {0, 0, d}, {0, d, 0}, kRed);     // right
  const float light = 1.5F;
  add_quad(scene, {-light, h - 0.01F, -light}, {2 * light, 0, 0}, {0, 0, 2 * light}, kLight);
}

// Its radius in a direction: a ball with dents of several sizes, which no two balls share.
float dented(glm::vec3 direction, float ball) {
  float radius = 1;
  float strength = 0.12F;
  float frequency = 3;
  for (int octave = 0; octave < 4; ++octave) {
    const glm::vec3 p = frequency * direction + ball;
    radius += strength * std::sin(p.x) * std::sin(p.y + 1) * std::sin(p.z + 2);
    strength /= 2;
    frequency *= 2.3F;
  }
  return radius;
}

// `rows` x `rows` patches of polar angle and azimuth, of two triangles but at the poles.
class Ball {
 public:
  Ball(glm::vec3 centre, float radius, float ball, std::uint32_t rows)
      : centre_(centre), radius_(radius), ball_(ball), rows_(rows) {}

  void add_to(Scene& scene) const {
    const auto first = static_cast<std::uint32_t>(scene.triangles.size());
    for (std::uint32_t row = 0; row < rows_; ++row) {
      for (std::uint32_t column = 0; column < rows_; ++column) {
        if (row > 0) add_triangle(scene, {{{row, column}, {row + 1, column + 1}, {row, column + 1}}});
        if (row + 1 < rows_) {
          add_triangle(scene, {{{row, column}, {row + 1, column}, {row + 1, column + 1}}});
        }
      }
    }
    const auto count = static_cast<std::uint32_t>(scene.triangles.size()) - first;
    scene.objects.push_back({"ball", first, count, true});
  }

 private:
  struct Corner {
    std::uint32_t row;
    std::uint32_t column;
  };

  glm::vec3 direction(Corner corner) const {
    const auto rows = static_cast<float>(rows_);
    const float theta = std::numbers::pi_v<float> * static_cast<float>(corner.row) / rows;
    const float phi = 2 * std::numbers::pi_v<float> * static_cast<float>(corner.column % rows_) / rows;
    // Of a pole there is one point alone, whatever the azimuth.
    const float sine = corner.row % rows_ == 0 ? 0 : std::sin(theta);
    return {sine * std::cos(phi), std::cos(theta), -sine * std::sin(phi)};
  }

  void add_triangle(Scene& scene, const std::array<Corner, 3>& corners) const {
    Triangle triangle;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const glm::vec3 d = direction(corners[i]);
      triangle.position[i] = centre_ + radius_ * dented(d, ball_) * d;
      triangle.uv[i] = glm::vec2(corners[i].column, corners[i].row) / static_cast<float>(rows_);
    }
    triangle.normal.fill(glm::vec3(glm::normalize(area_vector(triangle.position))));
    triangle.object = static_cast<std::uint32_t>(scene.objects.size());
    scene.triangles.push_back(triangle);
  }

  glm::vec3 centre_;
  float radius_;
  float ball_;
  std::uint32_t rows_;
};

void add_balls(Scene& scene, std::uint32_t triangles) {
  const std::uint32_t balls = std::clamp(triangles / kLeastOfBall, 1U, kMostBalls);
  // Of 2 rows (rows - 1) triangles.
  const auto rows = static_cast<std::uint32_t>(
      std::max(3.0, std::round(0.5 + std::sqrt(0.25 + triangles / (2.0 * balls)))));
  const float step = 2 * kHalf / kBallsPerSide;
  for (std::uint32_t i = 0; i < balls; ++i) {
    const std::uint32_t place = i * 29 % kMostBalls;  // 29 is prime to 64: few balls are spread out too
    const glm::vec3 cell(place % kBallsPerSide, place / kBallsPerSide % kBallsPerSide,
                         place / (kBallsPerSide * kBallsPerSide));
    const auto ball = static_cast<float>(i);
    const glm::vec3 shift = 0.15F * glm::vec3(std::sin(ball), std::sin(2 * ball), std::sin(3 * ball));
    const float radius = 0.6F + 0.2F * std::sin(5 * ball);
    Ball(-kHalf + step * (cell + 0.5F + shift), radius, ball, rows).add_to(scene);
  }
}

constexpr std::string_view kRoom = "room:";

std::uint32_t room_triangles(const std::string& name) {
  const std::string_view number = std::string_view(name).substr(kRoom.size());
  std::uint32_t triangles = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), triangles);
  constexpr std::uint32_t kLeast = 100;
  constexpr std::uint32_t kMost = 20'000'000;
  check(error == std::errc() && end == number.data() + number.size() && triangles >= kLeast &&
            triangles <= kMost,
        "scene '{}': room: is followed by a number of triangles from {} to {}", name, kLeast, kMost);
  return triangles;
}

}  // namespace

Scene room(std::uint32_t triangles) {
  Scene scene;
  scene.name = "room";
  scene.materials = {lambert(glm::vec3(0.7F)), lambert({0.7F, 0.2F, 0.2F}),
                     lambert(glm::vec3(0), glm::vec3(5))};
  scene.triangles.reserve(triangles);
  add_walls(scene);
  add_balls(scene, triangles);
  // Between the balls, from a corner into the room.
  scene.camera = look_at({4.6F, 1.2F, 4.6F}, {-2, -1, -3}, 1);
  return scene;
}

void check_scene(const std::string& name) {
  if (name.starts_with(kRoom))
    room_triangles(name);
  else
    check(std::filesystem::is_regular_file(name), "scene '{}': no such file, and not room:TRIANGLES", name);
}

Scene bench_scene(const std::string& name) {
  return name.starts_with(kRoom) ? room(room_triangles(name)) : load_gltf(name);
}

std::string shown_name(const std::string& name, const Scene& scene) {
  return name.starts_with(kRoom) ? name : scene.name;
}

}  // namespace qtrace::bench
