// Which of the ways to compile shaders a driver runs fastest: measured with the ray queries of paths in a
// small room of triangles, in a fraction of a second. All ways give the same answers.
#pragma once

#include "engine/gpu/context.h"
#include "engine/gpu/driver.h"

#include <string>
#include <vector>

namespace qtrace::gpu {

struct MeasuredWay {
  DriverChoices choices;
  double milliseconds = 0;  // median over interleaved rounds; of a software driver, of processor time
};

struct DriverMeasurement {
  DriverChoices best;  // the usual ones, unless others are faster by more than noise is
  std::vector<MeasuredWay> ways;
};

// Of the context, which is current and is left with the choices that it had.
DriverMeasurement measure_driver(Context& context);

}  // namespace qtrace::gpu
