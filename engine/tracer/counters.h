#pragma once

#include <cstdint>
#include <vector>

namespace qtrace {

// Where a sample was not finite: enough to replay it. Such samples count as 0 in the mean.
struct NonFiniteSample {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint32_t frame = 0;  // from 1; 0: in the pilot before it
};

// A pixel's brightest firefly. Brightness is the mean over channels, before clamping.
struct Firefly {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint32_t frame = 0;  // from 1
  double radiance = 0;
};

// What went beyond the limits in all frames so far; sums over pixels and frames of the mean over channels (as
// if all frames had the weight 1).
struct Outliers {
  double firefly_sum = 0;
  double clamped_away = 0;         // what clamp_radiance removed
  std::vector<Firefly> brightest;  // one of each pixel that had any: by radiance, then by position
};

// Counts of one frame.
struct FrameCounters {
  std::uint64_t paths = 0;
  std::uint64_t rays = 0;               // all rays traced, camera and shadow rays included
  std::uint64_t path_segments = 0;      // rays of the paths themselves, camera rays included
  std::uint64_t zero_paths = 0;         // paths whose sample is exactly zero
  std::uint64_t cell_lookups = 0;       // hits that asked for a cell
  std::uint64_t cell_fallbacks = 0;     // of these, hits for which no site qualified: BSDF sampling alone
  std::uint64_t non_finite = 0;         // samples with a NaN or an infinity
  std::uint64_t table_updates = 0;      // targets gathered for the Q-table
  std::uint64_t saturated_updates = 0;  // targets and splats clamped to, or lost at, the fixed-point limit
  std::uint64_t fireflies = 0;          // samples brighter than their pixel's threshold
  std::uint64_t clamped_samples = 0;    // samples with a channel above clamp_radiance
  std::uint64_t light_rays = 0;         // rays of paths from the lights, those to the camera included
  std::uint64_t splats = 0;             // connections of such paths to the camera that asked for a ray
  std::uint64_t connections = 0;        // of the camera's events to theirs, likewise

  FrameCounters& operator+=(const FrameCounters& other) {
    paths += other.paths;
    rays += other.rays;
    path_segments += other.path_segments;
    zero_paths += other.zero_paths;
    cell_lookups += other.cell_lookups;
    cell_fallbacks += other.cell_fallbacks;
    non_finite += other.non_finite;
    table_updates += other.table_updates;
    saturated_updates += other.saturated_updates;
    fireflies += other.fireflies;
    clamped_samples += other.clamped_samples;
    light_rays += other.light_rays;
    splats += other.splats;
    connections += other.connections;
    return *this;
  }
};

}  // namespace qtrace
