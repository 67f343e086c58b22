// The error of one pixel in each metric: what metrics average and heat maps show.
#pragma once

#include "engine/core/image.h"

#include <glm/vec3.hpp>

#include <vector>

namespace qtrace::experiments {

constexpr double kEpsilon = 0.01;  // keeps relative errors of dark pixels finite; radiance (squared)

bool is_finite(const glm::dvec3& v);
double channel_mean(const glm::dvec3& v);

// Of image a against reference r; each the mean over the channels.
double squared_error(const glm::dvec3& a, const glm::dvec3& r);
double relative_squared_error(const glm::dvec3& a, const glm::dvec3& r);
double absolute_percentage_error(const glm::dvec3& a, const glm::dvec3& r);
double symmetric_percentage_error(const glm::dvec3& a, const glm::dvec3& r);

using PixelError = double (*)(const glm::dvec3& a, const glm::dvec3& r);

// Throws Error unless both have one size.
void check_same_size(const RadianceImage& image, const RadianceImage& reference);

// Per pixel; NaN where image or reference is not finite. Throws Error where the sizes differ.
std::vector<double> map_errors(PixelError error, const RadianceImage& image, const RadianceImage& reference);

// The mean of the values that are finite; NaN if there is none.
double finite_mean(const std::vector<double>& values);

}  // namespace qtrace::experiments
