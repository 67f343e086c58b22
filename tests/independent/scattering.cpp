#include "tests/independent/scattering.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace qtrace::independent {
namespace {

constexpr double kPi = glm::pi<double>();

// The direction at an angle of this cosine to n.
glm::dvec3 about(const glm::dvec3& n, double cosine, double phi) {
  const glm::dvec3 other = std::abs(n.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 t = glm::normalize(glm::cross(n, other));
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return glm::normalize(cosine * n + sine * (std::cos(phi) * t + std::sin(phi) * glm::cross(n, t)));
}

// Of density D |N.H| (Walter et al. 2007, equation 35).
glm::dvec3 facet(const glm::dvec3& n, double roughness, Random& random) {
  const double phi = 2 * kPi * random(), u = random();
  const double a2 = std::pow(roughness, 4);
  return about(n, std::sqrt((1 - u) / (1 + (a2 - 1) * u)), phi);
}

glm::dvec3 mirrored(const glm::dvec3& eye, const glm::dvec3& h) { return 2 * glm::dot(eye, h) * h - eye; }

// Of a direction that is the eye's, mirrored at a facet.
double mirrored_density(const glm::dvec3& n, double roughness, const glm::dvec3& eye,
                        const glm::dvec3& direction) {
  const glm::dvec3 h = glm::normalize(direction + eye);
  const double n_h = glm::dot(n, h);
  return facet_distribution(roughness, n_h) * n_h / (4 * glm::dot(eye, h));
}

// Of a direction that is the eye's, refracted at a facet (Walter et al. 2007, equation 17).
double refracted_density(const Point& p, const glm::dvec3& direction) {
  const std::optional<glm::dvec3> h = refracting_facet(p, direction);
  if (!h) return 0;
  const auto [index_eye, index_light] = indices(p);
  const double n_h = glm::dot(p.normal, *h), l_h = glm::dot(direction, *h);
  const double root = index_light * l_h + index_eye * glm::dot(p.eye, *h);
  return facet_distribution(p.surface.roughness, n_h) * n_h * index_light * index_light * std::abs(l_h) /
         (root * root);
}

}  // namespace

// Roughly by what the lobes bring; at least a tenth where there is one, since the estimate may be far off.
Scattering::Scattering(const Point& p) : p_(p) {
  constexpr double kLeast = 0.1;
  const double coat = coat_share(p), reflectance = reflectance_estimate(p);
  const double passes = (1 - coat) * (1 - reflectance), through = p.surface.transmission;
  const bool is_glossy =
      (has_reflection(p) && !has_one_reflection(p)) || (has_coat(p) && !has_one_coat_reflection(p));
  if (has_diffuse(p) || is_glossy) chances_[kCosineAbove] = std::max(kLeast, passes * (1 - through));
  if (has_reflection(p)) chances_[kReflection] = std::max(kLeast, (1 - coat) * reflectance);
  if (has_transmission(p)) {
    chances_[kTransmission] = std::max(kLeast, passes * through);
    if (!has_one_transmission(p)) chances_[kCosineBelow] = kLeast;
  }
  if (has_coat(p)) chances_[kCoat] = std::max(kLeast, coat);
  const double sum = std::accumulate(chances_.begin(), chances_.end(), 0.0);
  for (double& chance : chances_) chance /= sum;
}

Scattering::Sample Scattering::sample(Random& random) const {
  const Technique technique = choose(random());
  if (has_one_direction(technique)) {
    const OneDirection one = technique == kReflection     ? reflected_part(p_)
                             : technique == kTransmission ? transmitted_part(p_)
                                                          : coat_part(p_);
    return {one.direction, one.part / chances_[technique], std::numeric_limits<double>::infinity()};
  }
  const glm::dvec3 direction = draw(technique, random);
  // A direction outside of a technique's own half is none of those that its density tells of.
  if (direction == glm::dvec3(0) || density(technique, direction) == 0) return {};
  const double all = density(direction);
  return {direction, scattered_part(p_, direction) / all, all};
}

double Scattering::density(const glm::dvec3& direction) const {
  double sum = 0;
  for (std::size_t k = 0; k < kTechniques; ++k) {
    const auto technique = static_cast<Technique>(k);
    if (chances_[k] > 0 && !has_one_direction(technique)) sum += chances_[k] * density(technique, direction);
  }
  return sum;
}

Scattering::Technique Scattering::choose(double random) const {
  std::size_t last = 0;
  for (std::size_t k = 0; k < kTechniques; ++k) {
    if (chances_[k] == 0) continue;
    last = k;
    if (random < chances_[k]) break;
    random -= chances_[k];
  }
  return static_cast<Technique>(last);
}

glm::dvec3 Scattering::draw(Technique technique, Random& random) const {
  const auto cosine = [&](const glm::dvec3& n) {
    const double phi = 2 * kPi * random();
    return about(n, std::sqrt(1 - random()), phi);
  };
  if (technique == kCosineAbove) return cosine(p_.normal);
  if (technique == kCosineBelow) return cosine(-p_.normal);
  if (technique == kCoat) {
    return mirrored(p_.eye, facet(p_.coat_normal, p_.surface.clearcoat_roughness, random));
  }
  const glm::dvec3 h = facet(p_.normal, p_.surface.roughness, random);
  if (technique == kReflection) return mirrored(p_.eye, h);
  if (p_.material->is_thin) return mirrored_at_plane(p_, mirrored(p_.eye, h));
  const auto [index_eye, index_light] = indices(p_);
  if (glm::dot(p_.eye, h) <= 0) return glm::dvec3(0);
  return refracted(p_.eye, h, index_eye / index_light).value_or(glm::dvec3(0));
}

double Scattering::density(Technique technique, const glm::dvec3& direction) const {
  const double n_l = glm::dot(p_.normal, direction);
  if (technique == kCosineAbove) return std::max(n_l, 0.0) / kPi;
  if (technique == kCosineBelow) return std::max(-n_l, 0.0) / kPi;
  if (technique == kCoat) {
    if (glm::dot(p_.coat_normal, direction) <= 0) return 0;
    return mirrored_density(p_.coat_normal, p_.surface.clearcoat_roughness, p_.eye, direction);
  }
  if (technique == kReflection) {
    return n_l > 0 ? mirrored_density(p_.normal, p_.surface.roughness, p_.eye, direction) : 0;
  }
  if (n_l >= 0) return 0;
  if (!p_.material->is_thin) return refracted_density(p_, direction);
  return mirrored_density(p_.normal, p_.surface.roughness, p_.eye, mirrored_at_plane(p_, direction));
}

bool Scattering::has_one_direction(Technique technique) const {
  if (technique == kReflection) return has_one_reflection(p_);
  if (technique == kTransmission) return has_one_transmission(p_);
  return technique == kCoat && has_one_coat_reflection(p_);
}

}  // namespace qtrace::independent
