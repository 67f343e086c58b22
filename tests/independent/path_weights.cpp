#include "tests/independent/path_weights.h"

#include "engine/device_scene/scene_features.h"
#include "engine/tracer/shader_variant.h"
#include "tests/independent/feature_rooms.h"
#include "tests/support/probe.h"
#include "tests/support/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace qtrace::independent {
namespace {

constexpr int kSize = 32;
constexpr std::size_t kMostEvents = 3;
constexpr std::uint32_t kPaths = kMostEvents << 13;
constexpr float kNoPath = -1;
constexpr float kTolerance = 1e-5F;

// Weights of a path of `count` events: x, as met by the camera's own path; y, by a light sample; z, by a
// light path; w, by all connections. All kNoPath where the path leaves the scene or carries nothing.
const char* const kFunctions = R"(
const uint MOST_EVENTS = 3u;

Event event_of(vec3 origin, vec3 direction, uint word, PathSums sums, bool is_first, out bool is_there) {
  Meeting met = meet(origin, direction, word);
  is_there = met.hit.triangle != NO_TRIANGLE;
  Event e;
  if (!is_there) return e;
  e.surface = met_surface(met, direction);
  e.wo = -direction;
  e.bsdf = bsdf_of(e.surface, e.wo);
#ifdef HAS_ABSORPTION
  e.medium = vec3(0.0);
#endif
  e.hit = met.hit;
  e.sums = sums;
  if (is_first) e.sums = sums_at_first(e);
  Tally tally;
  find_state(e, tally, true, true);
  return e;
}

// As a light path meets it that comes from `viewer`.
Event event_of_light(Event e, vec3 viewer, PathSums sums) {
  Event met = seen_from(e, viewer);
  met.sums = sums;
  return met;
}

vec4 weights_of(uint index, uint count) {
  RandomKey key = RandomKey(index, 1u, 5u);
  CameraRay ray = camera_ray(random_units(key, 2000u).xy * vec2(parameters.image_size));
  vec3 origin = ray.origin;
  vec3 direction = ray.direction;
  Event events[MOST_EVENTS];
  bool is_smooth[MOST_EVENTS];
  PathSums sums = PathSums(0.0, 0.0);
  vec3 left = origin;
  bool is_there;
  for (uint i = 0u; i < count; ++i) {
    events[i] = event_of(origin, direction, random_bits(key, 2001u + i).x, sums, i == 0u, is_there);
    is_smooth[i] = false;
#ifdef HAS_CONNECTIONS
    if (i > 0u && is_there) events[i].sums = sums_on_arrival(sums, events[i], left);
#endif
    if (!is_there) return vec4(-1.0);
    if (i + 1u == count) break;
    BsdfSample next = bsdf_sample_at(events[i], random_bits(key, 2010u + i));
    if (next.weight == vec3(0.0)) return vec4(-1.0);
#ifdef HAS_OWN_LOBES
    is_smooth[i] = next.direction.is_delta;
#endif
    sums = sums_after(events[i], next);
    left = events[i].surface.position;
    direction = next.direction.direction;
    origin = ray_origin(events[i].surface, direction);
  }

  Event last = events[count - 1u];
  uvec4 bits = random_bits(key, 2020u);
  uint word = random_bits(key, 2021u).x;
  LightSample light = sample_light(last.surface, cell_of(last), bits, word);
  vec3 to_light = light.direction;
  if (light.pdf <= 0.0 || bsdf_cosine(last.surface, last.bsdf, last.wo, to_light) == vec3(0.0)) return vec4(-1.0);
  uint index_of_triangle = choose_triangle(light.light, word);
  LampPoint point = sample_lamp_point(light.light, word, bits.yz);
  LightTriangle triangle = point.triangle;
  float t = length(point.position - last.surface.position);

  BsdfSample met;
  met.direction.direction = to_light;
  met.direction.pdf = direction_pdf(last, to_light);
#ifdef HAS_OWN_LOBES
  met.direction.is_delta = false;
#endif
  Surface lamp = last.surface;
  lamp.light = index_of_triangle;
  vec4 weights = vec4(0.0);
  weights.x = emission_weight(lamp, t, to_light, met.direction.pdf, cell_of(last), sums_after(last, met).chain);
#if NEE == NEE_ONE_RAY
  weights.y = light_weight(last, light);
#endif

  LightPath path;
  path.flux = vec3(1.0);
  path.light = light.light;
  path.is_far = false;
  path.arrivals = emission_choice(light.light) * lamp_direction_pdf(triangle, dot(triangle.normal.xyz, to_light));
  path.sums = PathSums(1.0 / lamp_emission_pdf(triangle), 0.0);
  vec3 viewer = to_light;
  bool is_reversible = true;
  for (uint i = count; i-- > 0u;) {
    uint bounce = count - 1u - i;
    Event e = event_of_light(events[i], viewer, path.sums);
    if (bounce == 0u) e.sums.last = light_samples_over(path, e, t);
#ifdef HAS_CONNECTIONS
    if (bounce > 0u) e.sums = sums_on_arrival(path.sums, e, events[i + 1u].surface.position);
#endif
    if (i == 0u) {
      CameraView view = camera_view(e.surface.position);
      Event seen = seen_by_camera(e, view.direction, path.tally);
      float density = view.density * face_cosine(e, view.direction) / float(parameters.light_paths);
      weights.z = weight_at_camera(path, e, seen, density);
      break;
    }
    BsdfDraw drawn;
    drawn.direction = events[i].wo;
    drawn.pdf = is_smooth[i] ? INFINITY : bsdf_pdf(e, drawn.direction);
#ifdef HAS_CONNECTIONS
    if (!is_smooth[i] && !is_smooth[i - 1u] && is_reversible) {
      Event seen = seen_by_camera(e, drawn.direction, path.tally);
      // In the direction of the path's ray, which starts off the surface: lobes of rough glass see the difference.
      float way = length(e.surface.position - events[i - 1u].surface.position);
      weights.w += connection_weight(events[i - 1u], e, seen, path.light, -drawn.direction, way);
    }
#endif
    // Where the normal of the mesh faces away from the camera, a mirror's way does not lead back: no light path takes it.
    if (pass_on(path, e, drawn) == vec3(0.0)) is_reversible = false;
    path.light = NO_LIGHT;
    viewer = -drawn.direction;
  }
  // Nothing is connected to an event that led on by a smooth lobe.
  if (is_smooth[0] || !is_reversible) weights.z = 0.0;
  return weights;
}
)";

// Of a third of all paths each has one event, two and three.
std::vector<glm::vec4> weights_of(const Scene& scene, const RenderSettings& settings) {
  Tracer tracer(test::device(), scene, settings);
  test::render(tracer, 6);  // teaches the table
  tracer.table();           // binds all that the probe reads
  const gpu::Defines defines = shader_defines(settings, gpu::find_features(scene));
  return test::probe<glm::vec4>("vec4",
                                {"geometry/camera.glsl", "light_path/light_path.glsl", "path/path.glsl",
                                 "path/trace.glsl", "sampling/state.glsl", "sampling/random.glsl"},
                                kFunctions, "result = weights_of(index, 1u + index % MOST_EVENTS);", kPaths,
                                defines);
}

struct WeightsFound {
  int paths = 0;
  int by_light = 0;       // with a weight of a tenth or more for the light path
  int by_connection = 0;  // likewise
  float worst = 0;        // distance of a path's sum of weights from one

  void add(const glm::vec4& w) {
    if (w.x == kNoPath) return;
    ++paths;
    if (w.z > 0.1F) ++by_light;
    if (w.w > 0.1F) ++by_connection;
    worst = std::max(worst, std::abs(w.x + w.y + w.z + w.w - 1));
  }
};

std::array<WeightsFound, kMostEvents> weights_found(const std::string& room, Sampler sampler, Nee nee,
                                                    LightPaths paths) {
  RenderSettings settings = test::square_settings(kSize, 5, nee);
  settings.sampler = sampler;
  settings.light_paths = paths;
  settings.light_path_trial = 0;
  settings.rl.trial_frames = 0;
  settings.rl.sites_per_object = 40;
  std::array<WeightsFound, kMostEvents> found;
  std::size_t index = 0;
  for (const glm::vec4& w : weights_of(feature_room(room), settings)) found[index++ % kMostEvents].add(w);
  return found;
}

}  // namespace

void expect_sums_of_one(const std::string& room, Sampler sampler, Nee nee, LightPaths paths) {
  std::size_t events = 0;
  for (const WeightsFound& found : weights_found(room, sampler, nee, paths)) {
    SCOPED_TRACE(testing::Message() << ++events << " events");
    EXPECT_GT(found.paths, 500);
    EXPECT_GT(found.by_light, found.paths / 100);
    EXPECT_LT(found.worst, kTolerance);
    const bool connects = paths == LightPaths::connect && events > 1;
    EXPECT_EQ(found.by_connection > found.paths / 100, connects);
  }
}

}  // namespace qtrace::independent
