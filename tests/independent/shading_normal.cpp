#include "tests/independent/shading_normal.h"

#include <glm/geometric.hpp>

namespace qtrace::independent {

glm::dvec3 mapped_normal(const glm::dvec3& value, double scale, const glm::dvec3& normal,
                         const glm::dvec4& tangent) {
  const glm::dvec3 along(tangent);
  const glm::dvec3 t = along - glm::dot(along, normal) * normal;
  const glm::dvec3 c = 2.0 * value - 1.0;
  const glm::dvec3 unit_t = glm::normalize(t);
  const glm::dvec3 b = tangent.w * glm::cross(normal, unit_t);
  const glm::dvec3 n = scale * c.x * unit_t + scale * c.y * b + c.z * normal;
  return glm::length(t) > 0 && glm::length(n) > 0 ? glm::normalize(n) : normal;
}

glm::dvec3 adapted_normal(const glm::dvec3& normal, const glm::dvec3& face, const glm::dvec3& eye) {
  constexpr double kLeast = 1e-3;  // cosine of the mirror's direction to the face's normal
  const glm::dvec3 mirrored = 2 * glm::dot(normal, eye) * normal - eye;
  const double cosine = glm::dot(mirrored, face);
  if (cosine < kLeast) {
    return glm::normalize(eye + glm::normalize(mirrored + (kLeast - cosine) * face));
  }
  return glm::dot(normal, eye) > 0 ? normal : glm::normalize(eye + mirrored);
}

}  // namespace qtrace::independent
