#include "tests/independent/surface.h"

#include "tests/independent/shading_normal.h"
#include "tests/independent/texture.h"

#include <glm/geometric.hpp>

#include <array>

namespace qtrace::independent {
namespace {

// A material at a place of a triangle.
class Place {
 public:
  Place(const Scene& scene, const Hit& hit)
      : scene_(scene), triangle_(scene.triangles[hit.triangle]), hit_(hit) {
    if (triangle_.attributes != kNoAttributes) attributes_ = &scene.attributes[triangle_.attributes];
  }

  const Material& material() const { return scene_.materials[triangle_.material]; }

  // White without a texture.
  glm::dvec4 texture(TextureSlot slot) const {
    const std::optional<Texture>& texture = material().texture(slot);
    if (!texture) return glm::dvec4(1);
    return look_up(scene_, *texture, slot, texture->uv_set == 0 ? interpolated(triangle_.uv) : uv1());
  }

  glm::dvec4 vertex_color() const { return attributes_ ? interpolated(attributes_->color) : glm::dvec4(1); }

  // On the front side.
  glm::dvec3 normal() const { return glm::normalize(interpolated(triangle_.normal)); }
  glm::dvec4 tangent() const { return attributes_ ? interpolated(attributes_->tangent) : glm::dvec4(0); }
  glm::dvec3 face() const { return glm::normalize(area_vector(triangle_.position)); }

 private:
  template <int N>
  glm::vec<N, double> interpolated(const std::array<glm::vec<N, float>, 3>& corners) const {
    using Value = glm::vec<N, double>;
    return (1 - hit_.u - hit_.v) * Value(corners[0]) + hit_.u * Value(corners[1]) +
           hit_.v * Value(corners[2]);
  }

  glm::dvec2 uv1() const { return attributes_ ? interpolated(attributes_->uv1) : glm::dvec2(0); }

  const Scene& scene_;
  const Triangle& triangle_;
  const Hit& hit_;
  const TriangleAttributes* attributes_ = nullptr;
};

glm::dvec4 base_color_and_opacity(const Place& place) {
  const Material& m = place.material();
  return glm::dvec4(glm::dvec3(m.base_color), m.opacity) * place.texture(TextureSlot::base_color) *
         place.vertex_color();
}

Surface surface_at(const Place& place) {
  const Material& m = place.material();
  const glm::dvec4 base = base_color_and_opacity(place);
  const glm::dvec4 metallic_roughness = place.texture(TextureSlot::metallic_roughness);
  Surface s;
  s.base_color = glm::dvec3(base);
  s.opacity = base.a;
  s.roughness = m.roughness * metallic_roughness.g;
  s.metallic = m.metallic * metallic_roughness.b;
  s.emission = glm::dvec3(m.emission) * glm::dvec3(place.texture(TextureSlot::emission));
  s.specular = m.specular * place.texture(TextureSlot::specular).a;
  s.specular_color = glm::dvec3(m.specular_color) * glm::dvec3(place.texture(TextureSlot::specular_color));
  s.transmission = m.ior > 0 ? m.transmission * place.texture(TextureSlot::transmission).r : 0;
  s.clearcoat = m.clearcoat * place.texture(TextureSlot::clearcoat).r;
  s.clearcoat_roughness = m.clearcoat_roughness * place.texture(TextureSlot::clearcoat_roughness).g;
  return s;
}

// The shading normal on the eye's side, of a slot with a texture of normals or none.
glm::dvec3 normal_of_slot(const Place& place, TextureSlot slot, double scale, const Point& p,
                          const glm::dvec3& interpolated) {
  if (!place.material().texture(slot)) return interpolated;
  const double side = p.from_front ? 1 : -1;
  const glm::dvec3 value(place.texture(slot));
  const glm::dvec3 mapped = side * mapped_normal(value, scale, side * interpolated, place.tangent());
  return adapted_normal(mapped, p.face, p.eye);
}

}  // namespace

Point point_at(const Scene& scene, const Hit& hit, const glm::dvec3& position, const glm::dvec3& eye) {
  const Place place(scene, hit);
  Point p;
  p.position = position;
  p.eye = eye;
  p.material = &place.material();
  p.surface = surface_at(place);
  const glm::dvec3 face = place.face();
  p.from_front = glm::dot(face, eye) > 0;
  const double side = p.from_front ? 1 : -1;
  p.face = side * face;
  glm::dvec3 normal = side * place.normal();
  if (!(glm::dot(normal, eye) > 0)) normal = p.face;  // it faces away from the ray, or is none
  p.normal = normal_of_slot(place, TextureSlot::normal, p.material->normal_scale, p, normal);
  p.coat_normal =
      normal_of_slot(place, TextureSlot::clearcoat_normal, p.material->clearcoat_normal_scale, p, normal);
  return p;
}

double chance_to_stop(const Scene& scene, const Hit& hit) {
  const Place place(scene, hit);
  const Material& m = place.material();
  if (m.alpha_mode == AlphaMode::opaque) return 1;
  const double opacity = base_color_and_opacity(place).a;
  if (m.alpha_mode == AlphaMode::blend) return opacity;
  return opacity >= m.alpha_cutoff ? 1 : 0;
}

glm::dvec3 emission_at(const Scene& scene, const Hit& hit) {
  const Place place(scene, hit);
  return glm::dvec3(place.material().emission) * glm::dvec3(place.texture(TextureSlot::emission));
}

}  // namespace qtrace::independent
