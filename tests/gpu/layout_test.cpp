// Every member of every shared struct: the driver's offset equals offsetof.
#include "engine/gpu/program.h"
#include "engine/gpu/structs.h"
#include "tests/support/device.h"

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <map>
#include <string>

namespace qtrace::gpu {
namespace {

struct Field {
  std::size_t offset;
  std::size_t stride;  // of the struct: sizeof
};

#define FIELD(Struct, member)                                         \
  {                                                                   \
#Struct "." #member, { offsetof(Struct, member), sizeof(Struct) } \
  }
const std::map<std::string, Field> kFields{FIELD(Counters, cut_pixel),
                                           FIELD(Counters, unused),
                                           FIELD(Counters, locations),
                                           FIELD(Counters, words),
                                           FIELD(Node, lo),
                                           FIELD(Node, hi),
                                           FIELD(WideNode, a),
                                           FIELD(WideNode, b),
                                           FIELD(NodeGrid, lo),
                                           FIELD(NodeGrid, scale),
                                           FIELD(TriangleShape, vertex0),
                                           FIELD(TriangleShape, vertex1),
                                           FIELD(TriangleShape, vertex2),
                                           FIELD(TriangleShade, normal0),
                                           FIELD(TriangleShade, normal1),
                                           FIELD(TriangleShade, normal2),
                                           FIELD(Material, base_color),
                                           FIELD(Material, emission),
                                           FIELD(Material, dielectric_f0),
                                           FIELD(Material, roughness),
                                           FIELD(Material, specular),
                                           FIELD(Material, normal_scale),
                                           FIELD(Material, transmission),
                                           FIELD(Material, absorption),
                                           FIELD(Material, coat),
                                           FIELD(Material, textures0),
                                           FIELD(Material, textures1),
                                           FIELD(Material, textures2),
                                           FIELD(TextureUse, u_row),
                                           FIELD(TextureUse, v_row),
                                           FIELD(TextureUse, modes),
                                           FIELD(LightTriangle, vertex),
                                           FIELD(LightTriangle, edge1),
                                           FIELD(LightTriangle, edge2),
                                           FIELD(LightTriangle, normal),
                                           FIELD(LightTriangle, radiance),
                                           FIELD(LightTriangle, link),
                                           FIELD(Light, choice),
                                           FIELD(Light, link),
                                           FIELD(Light, centre),
                                           FIELD(Light, axis),
                                           FIELD(Light, intensity),
                                           FIELD(Light, cone),
                                           FIELD(SkyTexel, radiance),
                                           FIELD(SkyTexel, link),
                                           FIELD(CellPlace, position),
                                           FIELD(CellPlace, normal),
                                           FIELD(Site, position),
                                           FIELD(Site, normal),
                                           FIELD(SiteRange, range),
                                           FIELD(SiteRange, frame),
                                           FIELD(TouchedHead, groups_x),
                                           FIELD(TouchedHead, groups_y),
                                           FIELD(TouchedHead, groups_z),
                                           FIELD(TouchedHead, count),
                                           FIELD(TargetSum, low),
                                           FIELD(TargetSum, middle),
                                           FIELD(TargetSum, high),
                                           FIELD(PixelSample, radiance),
                                           FIELD(PixelSample, counts),
                                           FIELD(PixelSplat, red),
                                           FIELD(PixelSplat, green),
                                           FIELD(PixelSplat, blue),
                                           FIELD(PixelSplat, unused),
                                           FIELD(LightVertex, flux),
                                           FIELD(LightVertex, chain),
                                           FIELD(LightVertex, wo),
                                           FIELD(LightVertex, last),
                                           FIELD(LightVertex, second),
                                           FIELD(LightVertex, third),
                                           FIELD(LightVertex, triangle),
                                           FIELD(LightVertex, light),
                                           FIELD(LightVertex, events),
                                           FIELD(LightVertex, way),
                                           FIELD(LightVertex, unused),
                                           FIELD(PixelSum, r),
                                           FIELD(PixelSum, g),
                                           FIELD(PixelSum, b),
                                           FIELD(PixelSum, r_squared),
                                           FIELD(PixelSum, g_squared),
                                           FIELD(PixelSum, b_squared),
                                           FIELD(PixelOutliers, firefly_sum),
                                           FIELD(PixelOutliers, clamped_away),
                                           FIELD(PixelOutliers, threshold),
                                           FIELD(PixelOutliers, brightest),
                                           FIELD(PixelOutliers, brightest_frame),
                                           FIELD(PixelOutliers, fireflies),
                                           FIELD(FirstHit, normal),
                                           FIELD(FirstHit, position),
                                           FIELD(FirstHit, albedo),
                                           FIELD(FirstHit, emission),
                                           FIELD(FilterGuide, normal),
                                           FIELD(FilterGuide, position),
                                           FIELD(FilterGuide, divided),
                                           FIELD(FilterPass, image_size),
                                           FIELD(FilterPass, spacing),
                                           FIELD(FilterPass, radiance_falloff),
                                           FIELD(FilterPass, normal_falloff),
                                           FIELD(FilterPass, position_falloff),
                                           FIELD(FilterPass, unused),
                                           FIELD(Incident, radiance),
                                           FIELD(Incident, bin_cosine),
                                           FIELD(Incident, centre_bin),
                                           FIELD(Incident, path_bin),
                                           FIELD(Incident, unused),
                                           FIELD(Parameters, camera_origin),
                                           FIELD(Parameters, camera_right),
                                           FIELD(Parameters, camera_up),
                                           FIELD(Parameters, camera_forward),
                                           FIELD(Parameters, film_right),
                                           FIELD(Parameters, film_up),
                                           FIELD(Parameters, environment),
                                           FIELD(Parameters, inverse_brightest),
                                           FIELD(Parameters, grid_origin),
                                           FIELD(Parameters, grid_boxes_per_unit),
                                           FIELD(Parameters, grid_boxes),
                                           FIELD(Parameters, cells),
                                           FIELD(Parameters, image_size),
                                           FIELD(Parameters, seed),
                                           FIELD(Parameters, lights),
                                           FIELD(Parameters, light_prior),
                                           FIELD(Parameters, max_bounces),
                                           FIELD(Parameters, russian_roulette_start),
                                           FIELD(Parameters, guided_bounces),
                                           FIELD(Parameters, clamp_radiance),
                                           FIELD(Parameters, bsdf_fraction),
                                           FIELD(Parameters, bin_floor),
                                           FIELD(Parameters, light_floor),
                                           FIELD(Parameters, cell_normal_threshold),
                                           FIELD(Parameters, rate_constant),
                                           FIELD(Parameters, rate_exponent),
                                           FIELD(Parameters, initial_value),
                                           FIELD(Parameters, shrinkage),
                                           FIELD(Parameters, roulette_scale),
                                           FIELD(Parameters, sky_size),
                                           FIELD(Parameters, sky_first),
                                           FIELD(Parameters, sky_turn),
                                           FIELD(Parameters, reach),
                                           FIELD(Parameters, light_paths),
                                           FIELD(Parameters, scene_centre),
                                           FIELD(Parameters, scene_radius),
                                           FIELD(Parameters, environment_share),
                                           FIELD(Parameters, disk_pdf),
                                           FIELD(Parameters, pixel_area),
                                           FIELD(Parameters, kept_paths),
                                           FIELD(Parameters, connections),
                                           FIELD(Parameters, unused),
                                           FIELD(Parameters, more_unused)};
#undef FIELD

GLint property(GLuint program, GLenum interface, GLuint index, GLenum name) {
  GLint value = -1;
  glGetProgramResourceiv(program, interface, index, 1, &name, 1, nullptr, &value);
  return value;
}

// The member of a uniform block that a shader reads, so that the block is active; none for other structs.
std::string block_member(const std::string& name) {
  return name == "Parameters" ? ".max_bounces" : name == "NodeGrid" ? ".lo.x" : "";
}

// A shader with an array of the struct in a storage buffer, or one of it in a uniform block.
Program program_with(const std::string& name) {
  const std::string member = block_member(name);
  const bool block = !member.empty();
  const std::string body =
      "#version 450 core\n#include \"shared/structs.glsl\"\nlayout(local_size_x = 1) in;\n" +
      std::string(block ? "layout(std140, binding = 0) uniform B { "
                        : "layout(std430, binding = 0) buffer B { ") +
      name + " items" + (block ? "" : "[]") + "; };\n" +
      "layout(std430, binding = 1) buffer O { uint o; };\nvoid main() { o = uint(items" +
      (block ? member : ".length()") + "); }\n";
  return Program(assemble("layout_test", body, {}));
}

std::string resource_name(GLuint program, GLenum interface, GLuint index) {
  char text[256];
  glGetProgramResourceName(program, interface, index, sizeof(text), nullptr, text);
  return text;
}

std::size_t check_struct(const std::string& name) {
  const Program program = program_with(name);
  const bool block = !block_member(name).empty();
  const GLenum interface = block ? GL_UNIFORM : GL_BUFFER_VARIABLE;
  GLint count = 0;
  glGetProgramInterfaceiv(program.id(), interface, GL_ACTIVE_RESOURCES, &count);
  std::size_t found = 0;
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    const std::string resource = resource_name(program.id(), interface, i);
    const std::string prefix = block ? "items." : "items[0].";
    if (!resource.starts_with(prefix)) continue;
    std::string key = name + "." + resource.substr(prefix.size());
    key = key.substr(0, key.find('['));  // of an array member
    SCOPED_TRACE(key);
    const auto field = kFields.find(key);
    if (field == kFields.end()) {
      ADD_FAILURE() << "member is not in the test's list";
      continue;
    }
    EXPECT_EQ(property(program.id(), interface, i, GL_OFFSET), static_cast<GLint>(field->second.offset));
    if (!block) {
      EXPECT_EQ(property(program.id(), interface, i, GL_TOP_LEVEL_ARRAY_STRIDE),
                static_cast<GLint>(field->second.stride));
    }
    ++found;
  }
  return found;
}

TEST(Layout, DriverAgreesWithCpp) {
  test::device();
  std::map<std::string, std::size_t> members;
  for (const auto& [key, field] : kFields) ++members[key.substr(0, key.find('.'))];
  for (const auto& [name, count] : members) EXPECT_EQ(check_struct(name), count) << name;
}

}  // namespace
}  // namespace qtrace::gpu
