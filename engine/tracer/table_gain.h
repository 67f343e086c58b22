// What the table is worth: the error of frames without it over that of frames with it.
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <vector>

namespace qtrace {

// Frames of one kind, pixel by pixel.
struct TriedFrames {
  std::vector<glm::dvec3> mean;
  std::vector<glm::dvec3> squared_error;  // of the mean, as replicates tell it
};

struct Gain {
  double value = 1;  // error of the first kind over that of the second
  double error = 0;  // its standard error
  double found = 1;  // radiance of the first kind over that of the second
};

// Errors are relative, as relMSE is: over the squared radiance of the blocks of pixels around. `width`: of
// the picture. Where samples of the second kind do not differ, or only in few blocks, the gain says nothing:
// its own error is infinite.
Gain gain_of(const std::array<TriedFrames, 2>& kinds, int width);

}  // namespace qtrace
