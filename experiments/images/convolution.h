// Separable filters of planes of numbers; beyond the border stands the nearest pixel's value.
#pragma once

#include <vector>

namespace qtrace::experiments {

struct Plane {
  int width = 0;
  int height = 0;
  std::vector<double> values;  // top row first
};

using Kernel = std::vector<double>;  // of odd length, its centre in the middle; applied as correlation

// exp(-x^2 / (2 sigma^2)) at the whole numbers within `radius`, divided by its sum.
Kernel gaussian(double sigma, int radius);

// All positive weights divided by their sum, all negative ones by theirs.
Kernel balanced(Kernel kernel);

Plane convolve(const Plane& plane, const Kernel& across, const Kernel& down);

}  // namespace qtrace::experiments
