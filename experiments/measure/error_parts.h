// The error of a sampler in two parts that need several seeds to tell apart: variance, which more samples
// remove, and bias, which they do not.
#pragma once

#include "engine/core/image.h"
#include "experiments/measure/statistics.h"

#include <functional>
#include <optional>

namespace qtrace::experiments {

// Over pixels and channels that are finite everywhere, for R seeds with images x_i, their mean m, and
// reference r:
//   variance = mean(sum_i (x_i - m)^2 / (R - 1))                        of one run
//   bias2    = mean((m - r)^2) - variance / R - mean(var(r))            so that E(mse) = variance + bias2 +
//   var(r)
// Both are without bias; bias2 may come out negative. Its interval is Student's over the jackknife's
// pseudo-values (Tukey 1958: R b - (R - 1) b without seed i) and needs three seeds. It is about the seeds
// alone: the reference is one image, whose noise var(r) leaves bias2 off by a fixed amount that is small
// against mean(var(r)).
struct ErrorParts {
  double variance = 0;
  Estimate bias2;

  double abs_bias() const;  // sqrt(max(bias2, 0))
  std::optional<double> abs_bias_low() const;
  std::optional<double> abs_bias_high() const;
};

// `image(i)` returns the final image of seed i and is called twice for each: three images are held at a time,
// whatever `seeds` is. Nothing for fewer than two seeds or where no pixel is finite.
std::optional<ErrorParts> separate_errors(std::size_t seeds,
                                          const std::function<RadianceImage(std::size_t)>& image,
                                          const RadianceImage& reference);

}  // namespace qtrace::experiments
