#include "tests/bench/embree.h"

#include "engine/core/check.h"
#include "tests/bench/timing.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>
#include <string>

namespace qtrace::bench {
namespace {

// Small enough that no thread waits long for another at the end.
constexpr std::size_t kChunk = 2048;

// Calls work(first, end) for chunks of `count` things, on threads that stay between calls.
template <class Work>
void in_chunks(std::size_t count, unsigned threads, const Work& work) {
  tbb::task_arena arena(static_cast<int>(threads));
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kChunk),
                      [&](const auto& range) { work(range.begin(), range.end()); });
  });
}

void set_ray(RTCRay& ray, const BenchRay& from, float most) {
  ray.org_x = from.origin.x;
  ray.org_y = from.origin.y;
  ray.org_z = from.origin.z;
  ray.tnear = 0;
  ray.dir_x = from.direction.x;
  ray.dir_y = from.direction.y;
  ray.dir_z = from.direction.z;
  ray.time = 0;
  ray.tfar = most;
  ray.mask = std::numeric_limits<unsigned>::max();
  ray.id = 0;
  ray.flags = 0;
}

#if QTRACE_EMBREE == 3
void intersect(RTCScene scene, RTCRayHit& query) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &query);
}

void occlude(RTCScene scene, RTCRay& query) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &query);
}
#else
void intersect(RTCScene scene, RTCRayHit& query) { rtcIntersect1(scene, &query); }
void occlude(RTCScene scene, RTCRay& query) { rtcOccluded1(scene, &query); }
#endif

void copy_vertices(RTCGeometry geometry, const Scene& scene) {
  const std::size_t count = scene.triangles.size();
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * count));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), count));
  check(vertices != nullptr && indices != nullptr, "Embree has no memory for {} triangles", count);
  for (std::size_t i = 0; i < 3 * count; ++i) {
    const glm::vec3& p = scene.triangles[i / 3].position[i % 3];
    std::copy_n(&p.x, 3, vertices + 3 * i);
    indices[i] = static_cast<unsigned>(i);
  }
}

}  // namespace

EmbreeScene::EmbreeScene(const Scene& scene, unsigned threads)
    : threads_(threads),
      device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())),
      scene_(rtcNewScene(device_.get())) {
  const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  copy_vertices(geometry, scene);
  const auto build = [&] {
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_.get());
  };
  build_s_ = timed(build, [] {}).wall_s;
  check(rtcGetDeviceError(device_.get()) == RTC_ERROR_NONE, "Embree could not build the scene {}",
        scene.name);
}

void EmbreeScene::closest_hits(const std::vector<BenchRay>& rays, std::vector<Answer>& answers) const {
  answers.resize(rays.size());
  in_chunks(rays.size(), threads_, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      RTCRayHit query;
      set_ray(query.ray, rays[i], std::numeric_limits<float>::infinity());
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      query.hit.primID = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      intersect(scene_.get(), query);
      answers[i] = {query.ray.tfar, query.hit.primID};
    }
  });
}

void EmbreeScene::occlusions(const std::vector<BenchRay>& rays, std::vector<Answer>& answers) const {
  answers.resize(rays.size());
  in_chunks(rays.size(), threads_, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      RTCRay query;
      set_ray(query, rays[i], 1);
      occlude(scene_.get(), query);
      answers[i] = {query.tfar < 0 ? 1.0F : 0.0F, RTC_INVALID_GEOMETRY_ID};
    }
  });
}

}  // namespace qtrace::bench
