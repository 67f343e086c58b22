// Embree 3 or 4, as its users call it: one ray at a time, on the threads that it builds with.
#pragma once

#include "engine/scene/scene.h"
#include "tests/bench/rays.h"

#if QTRACE_EMBREE == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include <memory>
#include <vector>

namespace qtrace::bench {

class EmbreeScene {
 public:
  EmbreeScene(const Scene& scene, unsigned threads);

  // The nearest hits by rtcIntersect1.
  void closest_hits(const std::vector<BenchRay>& rays, std::vector<Answer>& answers) const;
  // By rtcOccluded1, up to t = 1.
  void occlusions(const std::vector<BenchRay>& rays, std::vector<Answer>& answers) const;

  double build_s() const { return build_s_; }

 private:
  struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };

  unsigned threads_;
  double build_s_ = 0;
  std::unique_ptr<RTCDeviceTy, Release> device_;
  std::unique_ptr<RTCSceneTy, Release> scene_;
};

}  // namespace qtrace::bench
