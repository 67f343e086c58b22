// FLIP for displayed images: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild 2020, FLIP: A
// difference evaluator for alternating images (HPG). How much an observer sees when two images alternate.
#pragma once

#include <glm/vec3.hpp>

#include <numbers>
#include <vector>

namespace qtrace::experiments {

// The observer that the paper assumes: 0.7 m before a screen 0.7 m and 3840 pixels wide. 67.02.
constexpr double kPixelsPerDegree = 0.7 * 3840 / 0.7 * std::numbers::pi / 180;

// What is on a screen: linear Rec. 709 in [0, 1], top row first.
struct DisplayImage {
  int width = 0;
  int height = 0;
  std::vector<glm::dvec3> pixels;
};

// For each pixel between 0 (no difference) and 1; symmetric in its arguments, which must have one size.
std::vector<double> ldr_flip(const DisplayImage& a, const DisplayImage& b);

}  // namespace qtrace::experiments
