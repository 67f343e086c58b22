#include "tests/independent/material.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace qtrace::independent {
namespace {

constexpr double kPi = glm::pi<double>();

double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

// Where shading normal and face agree.
bool is_above(const Point& p, const glm::dvec3& normal, const glm::dvec3& direction) {
  return glm::dot(normal, direction) > 0 && glm::dot(p.face, direction) > 0;
}
bool is_below(const Point& p, const glm::dvec3& direction) {
  return glm::dot(p.normal, direction) < 0 && glm::dot(p.face, direction) < 0;
}

// B.2.3: the visibility V = G / (4 |N.L| |N.V|), with a chi of 1.
double visibility(double roughness, double n_l, double n_v) {
  const double a2 = std::pow(roughness, 4);
  return 0.5 / (n_l * std::sqrt(n_v * n_v * (1 - a2) + a2) + n_v * std::sqrt(n_l * n_l * (1 - a2) + a2));
}

// specular_brdf of appendix B: D V.
double specular_brdf(double roughness, const glm::dvec3& n, const glm::dvec3& to_light,
                     const glm::dvec3& to_eye) {
  const glm::dvec3 h = glm::normalize(to_light + to_eye);
  return facet_distribution(roughness, glm::dot(n, h)) *
         visibility(roughness, glm::dot(n, to_light), glm::dot(n, to_eye));
}

glm::dvec3 schlick(const glm::dvec3& f0, double f90, double cosine) {
  return f0 + (f90 - f0) * std::pow(1 - std::abs(cosine), 5);
}

// KHR_materials_ior and _specular. Schlick's cosine is the one on the side of the lower index; where there is
// none, all is reflected.
glm::dvec3 dielectric_fresnel(const Point& p, double v_h) {
  double cosine = std::abs(v_h);
  const double ior = p.material->ior;
  if (p.is_inside()) {
    const double sine2 = ior * ior * (1 - cosine * cosine);
    if (sine2 >= 1) return glm::dvec3(1);
    cosine = std::sqrt(1 - sine2);
  }
  const double root = ior == 0 ? 1 : (ior - 1) / (ior + 1);
  const glm::dvec3 f0 = glm::min(root * root * p.surface.specular_color, glm::dvec3(1)) * p.surface.specular;
  return schlick(f0, p.surface.specular, cosine);
}

glm::dvec3 fresnel(const Point& p, double v_h) {
  return glm::mix(dielectric_fresnel(p, v_h), schlick(p.surface.base_color, 1, v_h), p.surface.metallic);
}

// Of what passes a facet into the dielectric, the part that is transmitted there.
glm::dvec3 passing_part(const Point& p, double v_h) {
  return (1 - p.surface.metallic) * p.surface.transmission * (1 - largest(dielectric_fresnel(p, v_h))) *
         p.surface.base_color;
}

// f times |N.L| of base_layer * (1 - F) + F * specular_brdf, without its transmission.
glm::dvec3 base_reflection(const Point& p, const glm::dvec3& to_light) {
  if (!is_above(p, p.normal, to_light)) return glm::dvec3(0);
  const double v_h = glm::dot(p.eye, glm::normalize(to_light + p.eye));
  glm::dvec3 f(0);
  if (has_diffuse(p)) {
    f = (1 - p.surface.metallic) * (1 - p.surface.transmission) * (1 - largest(dielectric_fresnel(p, v_h))) *
        p.surface.base_color / kPi;
  }
  if (has_reflection(p) && !has_one_reflection(p)) {
    f += fresnel(p, v_h) * specular_brdf(p.surface.roughness, p.normal, to_light, p.eye);
  }
  return f * glm::dot(p.normal, to_light);
}

// KHR_materials_transmission: the lobe of reflection, mirrored at the surface.
glm::dvec3 thin_transmission(const Point& p, const glm::dvec3& to_light) {
  const glm::dvec3 above = mirrored_at_plane(p, to_light);
  const double v_h = glm::dot(p.eye, glm::normalize(above + p.eye));
  return passing_part(p, v_h) * specular_brdf(p.surface.roughness, p.normal, above, p.eye) *
         glm::dot(p.normal, above);
}

// Walter et al. 2007, equation 21, without its Fresnel term, times |N.L|; G as in reflection
// (KHR_materials_volume).
glm::dvec3 volume_transmission(const Point& p, const glm::dvec3& to_light) {
  const std::optional<glm::dvec3> h = refracting_facet(p, to_light);
  if (!h) return glm::dvec3(0);
  const auto [index_eye, index_light] = indices(p);
  const double l_h = glm::dot(to_light, *h), v_h = glm::dot(p.eye, *h);
  const double n_l = std::abs(glm::dot(p.normal, to_light)), n_v = glm::dot(p.normal, p.eye);
  const double g = 4 * n_l * n_v * visibility(p.surface.roughness, n_l, n_v);
  const double d = facet_distribution(p.surface.roughness, glm::dot(p.normal, *h));
  const double root = index_light * l_h + index_eye * v_h;
  const double f = std::abs(l_h * v_h) / (n_l * n_v) * index_eye * index_eye * g * d / (root * root);
  return passing_part(p, v_h) * f * n_l;
}

glm::dvec3 base_transmission(const Point& p, const glm::dvec3& to_light) {
  if (!has_transmission(p) || has_one_transmission(p) || !is_below(p, to_light)) return glm::dvec3(0);
  return p.material->is_thin ? thin_transmission(p, to_light) : volume_transmission(p, to_light);
}

double coat_reflection(const Point& p, const glm::dvec3& to_light) {
  if (!has_coat(p) || has_one_coat_reflection(p) || !is_above(p, p.coat_normal, to_light)) return 0;
  return specular_brdf(p.surface.clearcoat_roughness, p.coat_normal, to_light, p.eye) *
         glm::dot(p.coat_normal, to_light);
}

glm::dvec3 mirrored(const glm::dvec3& eye, const glm::dvec3& normal) {
  return 2 * glm::dot(eye, normal) * normal - eye;
}

}  // namespace

bool has_diffuse(const Point& p) { return p.surface.metallic < 1 && p.surface.transmission < 1; }
bool has_reflection(const Point& p) {
  return p.surface.metallic > 0 || p.surface.specular > 0 || p.is_inside();
}
bool has_transmission(const Point& p) { return p.surface.metallic < 1 && p.surface.transmission > 0; }
bool has_coat(const Point& p) { return p.surface.clearcoat > 0; }
bool has_one_reflection(const Point& p) { return p.surface.roughness < kSmooth; }
bool has_one_transmission(const Point& p) {
  // Where the index does not change, no facet bends the light.
  return p.surface.roughness < kSmooth || (!p.material->is_thin && p.material->ior == 1);
}
bool has_one_coat_reflection(const Point& p) { return p.surface.clearcoat_roughness < kSmooth; }

// B.2.3: D.
double facet_distribution(double roughness, double n_h) {
  const double a2 = std::pow(roughness, 4);
  const double f = n_h * n_h * (a2 - 1) + 1;
  return a2 / (kPi * f * f);
}

double coat_share(const Point& p) {
  if (!has_coat(p)) return 0;
  return p.surface.clearcoat * schlick(glm::dvec3(0.04), 1, glm::dot(p.eye, p.coat_normal)).x;
}

Indices indices(const Point& p) {
  if (p.material->is_thin) return {};
  const double ior = p.material->ior;
  return p.from_front ? Indices{1, ior} : Indices{ior, 1};
}

std::optional<glm::dvec3> refracting_facet(const Point& p, const glm::dvec3& to_light) {
  const auto [index_eye, index_light] = indices(p);
  glm::dvec3 h = glm::normalize(index_light * to_light + index_eye * p.eye);
  if (glm::dot(h, p.normal) < 0) h = -h;
  if (!(glm::dot(p.eye, h) > 0 && glm::dot(to_light, h) < 0)) return {};
  return h;
}

glm::dvec3 mirrored_at_plane(const Point& p, const glm::dvec3& direction) {
  return direction - 2 * glm::dot(p.normal, direction) * p.normal;
}

glm::dvec3 scattered_part(const Point& p, const glm::dvec3& to_light) {
  return glm::mix(base_reflection(p, to_light) + base_transmission(p, to_light),
                  glm::dvec3(coat_reflection(p, to_light)), coat_share(p));
}

OneDirection reflected_part(const Point& p) {
  const glm::dvec3 direction = mirrored(p.eye, p.normal);
  if (!is_above(p, p.normal, direction)) return {};
  return {direction, (1 - coat_share(p)) * fresnel(p, glm::dot(p.eye, p.normal))};
}

OneDirection transmitted_part(const Point& p) {
  const auto [index_eye, index_light] = indices(p);
  const std::optional<glm::dvec3> direction = refracted(p.eye, p.normal, index_eye / index_light);
  if (!direction || !is_below(p, *direction)) return {};
  const double compression = index_eye * index_eye / (index_light * index_light);
  const double v_n = glm::dot(p.eye, p.normal);
  return {*direction, (1 - coat_share(p)) * compression * passing_part(p, v_n)};
}

OneDirection coat_part(const Point& p) {
  const glm::dvec3 direction = mirrored(p.eye, p.coat_normal);
  if (!is_above(p, p.coat_normal, direction)) return {};
  return {direction, glm::dvec3(coat_share(p))};
}

std::optional<glm::dvec3> refracted(const glm::dvec3& eye, const glm::dvec3& facet, double index_ratio) {
  const double cosine = glm::dot(eye, facet);
  const double rest = 1 - index_ratio * index_ratio * (1 - cosine * cosine);
  if (rest <= 0) return {};
  return glm::normalize(-index_ratio * eye + (index_ratio * cosine - std::sqrt(rest)) * facet);
}

double reflectance_estimate(const Point& p) {
  return std::min(1.0, largest(fresnel(p, glm::dot(p.eye, p.normal))));
}

}  // namespace qtrace::independent
