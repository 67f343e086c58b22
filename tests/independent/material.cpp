#include "tests/independent/material.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace qtrace::independent {
namespace {

constexpr double kPi = glm::pi<double>();

// B.2.3: the visibility V = G / (4 |N.L| |N.V|), with a chi of 1.
double visibility(double alpha, double n_l, double n_v) {
  const double a2 = alpha * alpha;
  return 0.5 / (n_l * std::sqrt(n_v * n_v * (1 - a2) + a2) + n_v * std::sqrt(n_l * n_l * (1 - a2) + a2));
}

glm::dvec3 fresnel(const glm::dvec3& f0, double f90, double v_h) {
  return f0 + (f90 - f0) * std::pow(1 - std::abs(v_h), 5);
}

}  // namespace

bool has_lobe(const Material& m) { return m.metallic > 0 || m.specular > 0; }

// B.2.3: D.
double facet_distribution(const Material& m, double n_h) {
  const double a2 = std::pow(double{m.roughness}, 4);
  const double f = n_h * n_h * (a2 - 1) + 1;
  return a2 / (kPi * f * f);
}

glm::dvec3 reflect(const Material& m, const glm::dvec3& n, const glm::dvec3& to_light,
                   const glm::dvec3& to_eye) {
  const glm::dvec3 h = glm::normalize(to_light + to_eye);
  const double v_h = glm::dot(to_eye, h);
  const glm::dvec3 base(m.base_color);
  const double alpha = double{m.roughness} * m.roughness;
  const double lobe = has_lobe(m) ? facet_distribution(m, glm::dot(n, h)) *
                                        visibility(alpha, glm::dot(n, to_light), glm::dot(n, to_eye))
                                  : 0;
  // The dielectric of index 1.5, as the extension scales it.
  const glm::dvec3 f0 = glm::min(0.04 * glm::dvec3(m.specular_color), glm::dvec3(1)) * double{m.specular};
  const glm::dvec3 f = fresnel(f0, m.specular, v_h);
  const glm::dvec3 dielectric = (1 - std::max({f.x, f.y, f.z})) * base / kPi + f * lobe;
  const glm::dvec3 metal = fresnel(base, 1, v_h) * lobe;
  return glm::mix(dielectric, metal, double{m.metallic});
}

}  // namespace qtrace::independent
