// Which planes the project's images have in their files.
#pragma once

#include "engine/core/image.h"
#include "experiments/images/exr.h"

#include <array>
#include <filesystem>

namespace qtrace::experiments {

inline constexpr const char* kVarianceNote = "varianceNote";  // metadata: what the variance rests on

// R, G, B: the mean; variance.R, .G, .B: its variance; metadata "spp".
ExrImage to_exr(const RadianceImage& image, ExrMetadata metadata);

// Adds filtered.R, .G, .B: the same image after a filter.
void add_filtered(ExrImage& exr, const RadianceImage& filtered);

// Adds half1.R, .G, .B and half2.R, .G, .B: the means over two halves of the samples, whose difference shows
// the noise without trust in the variance.
void add_halves(ExrImage& exr, const std::array<RadianceImage, 2>& halves);

// normal.X, .Y, .Z, position.X, .Y, .Z, albedo.R, .G, .B and emission.R, .G, .B.
ExrImage to_exr(const FirstHitImage& image, ExrMetadata metadata);

// The opposite of to_exr. Without variance channels the variance is zero and `samples` 0, i. e. unknown;
// with them `samples` is the metadata's spp, or 2 where it names none. Throws Error unless R, G, B are there.
RadianceImage to_radiance(const ExrImage& image, const std::filesystem::path& file);

}  // namespace qtrace::experiments
