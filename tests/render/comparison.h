// Small renders of shipped scenes, compared block by block.
#pragma once

#include "tests/support/render.h"

namespace qtrace::test {

inline constexpr int kSize = 64;
inline constexpr int kBlock = 16;
inline constexpr int kBlocks = (kSize / kBlock) * (kSize / kBlock);
// Where few paths carry most of the light, larger blocks bring the mean nearer to a normal distribution.
inline constexpr int kLargeBlock = 32;
inline constexpr int kLargeBlocks = (kSize / kLargeBlock) * (kSize / kLargeBlock);

RenderSettings base_settings(std::uint32_t seed);

Scene shipped(const char* name);

// The Cornell box with metal and plastic, and a second light, dimmer, double-sided and tilted.
Scene glossy_room();

// Compares blocks of pixels by their z-scores, at a chance of false alarm shared by `comparisons`.
void expect_same_image(const Rendering& a, const Rendering& b, std::size_t comparisons, int size = kBlock);

}  // namespace qtrace::test
