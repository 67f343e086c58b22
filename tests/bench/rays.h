// Rays as path tracing asks for them, the same for everything that is compared.
#pragma once

#include "engine/scene/scene.h"

#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace qtrace::bench {

// As the shader fetches it.
struct BenchRay {
  glm::vec4 origin;     // xyz
  glm::vec4 direction;  // xyz; of shadow rays to the end of the segment
};

// As the shader writes it.
struct Answer {
  float t = 0;                 // infinite where nothing is hit; of shadow rays 1 where something is, else 0
  std::uint32_t triangle = 0;  // in the order of whoever answers
};

enum class RayKind { primary, bounce, shadow };
inline constexpr std::array<std::string_view, 3> kRayKinds{"primary", "diffuse bounce", "shadow"};

struct RaySets {
  std::vector<BenchRay> primary;
  std::vector<BenchRay> bounce;
  std::vector<BenchRay> shadow;

  const std::vector<BenchRay>& of(RayKind kind) const {
    return kind == RayKind::primary ? primary : kind == RayKind::bounce ? bounce : shadow;
  }
};

class EmbreeScene;

// For an image of `size` x `size` pixels: a ray through each, in the tracer's order of 8 x 8 tiles; from each
// of their hits, in the same order, a cosine-distributed one, and one to a point on a light, all points of
// which are as likely, or on any surface where there is no light.
RaySets make_rays(const Scene& scene, const EmbreeScene& embree, int size);

// By the octant of their directions, then along a Morton curve through their origins.
std::vector<BenchRay> sorted_rays(const std::vector<BenchRay>& rays);

}  // namespace qtrace::bench
