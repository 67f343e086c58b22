// Samples that are far brighter than their pixel, and what clamping them costs.
#pragma once

#include "engine/core/image.h"
#include "engine/tracer/counters.h"
#include "experiments/files/json.h"
#include "experiments/records/records.h"

#include <vector>

namespace qtrace::experiments {

// Brightness (mean over channels) above which a sample of a pixel is a firefly, in the order of the pixels.
std::vector<float> firefly_thresholds(const RadianceImage& reference, double multiple);

// `image`: the mean over all the samples among which the outliers are.
FireflyRecord firefly_record(const Outliers& outliers, const RadianceImage& image);

// What clamping added to the image's mean over pixels and channels; never positive.
double clamp_bias(const Outliers& outliers, const RadianceImage& image);

// The brightest ones, at most 64: x, y, frame, radiance and radiance as a multiple of the reference.
Json brightest_fireflies(const Outliers& outliers, const RadianceImage& reference);

}  // namespace qtrace::experiments
