#include "experiments/images/convolution.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace qtrace::experiments {
namespace {

// One row with each end repeated `radius` times.
void pad_row(const double* row, std::size_t width, std::size_t radius, std::vector<double>& padded) {
  padded.resize(width + 2 * radius);
  const auto middle = padded.begin() + static_cast<std::ptrdiff_t>(radius);
  std::fill(padded.begin(), middle, row[0]);
  std::copy(row, row + width, middle);
  std::fill(middle + static_cast<std::ptrdiff_t>(width), padded.end(), row[width - 1]);
}

void add_scaled(double weight, const double* row, std::size_t width, double* sum) {
  for (std::size_t x = 0; x < width; ++x) sum[x] += weight * row[x];
}

}  // namespace

Kernel gaussian(double sigma, int radius) {
  Kernel kernel;
  for (int x = -radius; x <= radius; ++x) kernel.push_back(std::exp(-x * x / (2 * sigma * sigma)));
  return balanced(std::move(kernel));
}

Kernel balanced(Kernel kernel) {
  double positive = 0, negative = 0;
  for (const double weight : kernel) (weight > 0 ? positive : negative) += std::abs(weight);
  for (double& weight : kernel) {
    if (weight != 0) weight /= weight > 0 ? positive : negative;
  }
  return kernel;
}

Plane convolve(const Plane& plane, const Kernel& across, const Kernel& down) {
  const auto width = static_cast<std::size_t>(plane.width);
  const auto height = static_cast<std::size_t>(plane.height);
  std::vector<double> rows(plane.values.size(), 0.0), padded;
  for (std::size_t y = 0; y < height; ++y) {
    pad_row(&plane.values[y * width], width, across.size() / 2, padded);
    for (std::size_t k = 0; k < across.size(); ++k)
      add_scaled(across[k], &padded[k], width, &rows[y * width]);
  }
  Plane result{plane.width, plane.height, std::vector<double>(plane.values.size(), 0.0)};
  const auto radius = static_cast<std::ptrdiff_t>(down.size() / 2);
  const auto last = static_cast<std::ptrdiff_t>(height) - 1;
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t k = 0; k < down.size(); ++k) {
      const auto from = std::clamp(static_cast<std::ptrdiff_t>(y + k) - radius, std::ptrdiff_t{0}, last);
      add_scaled(down[k], &rows[static_cast<std::size_t>(from) * width], width, &result.values[y * width]);
    }
  }
  return result;
}

}  // namespace qtrace::experiments
