#include "experiments/images/exr_images.h"

#include "engine/core/check.h"

#include <array>
#include <charconv>

namespace qtrace::experiments {
namespace {

constexpr std::array<const char*, 3> kMean{"R", "G", "B"};
constexpr std::array<const char*, 3> kVariance{"variance.R", "variance.G", "variance.B"};
constexpr std::array<const char*, 3> kNormal{"normal.X", "normal.Y", "normal.Z"};
constexpr std::array<const char*, 3> kPosition{"position.X", "position.Y", "position.Z"};
constexpr std::array<const char*, 3> kAlbedo{"albedo.R", "albedo.G", "albedo.B"};
constexpr std::array<const char*, 3> kEmission{"emission.R", "emission.G", "emission.B"};
constexpr std::array<const char*, 3> kFiltered{"filtered.R", "filtered.G", "filtered.B"};
constexpr std::array<const char*, 3> kHalf1{"half1.R", "half1.G", "half1.B"};
constexpr std::array<const char*, 3> kHalf2{"half2.R", "half2.G", "half2.B"};

template <class Vector>
void add_planes(ExrImage& exr, const std::array<const char*, 3>& names, const std::vector<Vector>& pixels) {
  for (int c = 0; c < 3; ++c) {
    std::vector<float>& plane = exr.channels[names[static_cast<std::size_t>(c)]];
    plane.reserve(pixels.size());
    for (const Vector& pixel : pixels) plane.push_back(static_cast<float>(pixel[c]));
  }
}

bool has_planes(const ExrImage& exr, const std::array<const char*, 3>& names) {
  for (const char* name : names) {
    if (!exr.channels.contains(name)) return false;
  }
  return true;
}

std::vector<glm::dvec3> get_planes(const ExrImage& exr, const std::array<const char*, 3>& names) {
  const auto& r = exr.channels.at(names[0]);
  const auto& g = exr.channels.at(names[1]);
  const auto& b = exr.channels.at(names[2]);
  std::vector<glm::dvec3> pixels;
  pixels.reserve(r.size());
  for (std::size_t i = 0; i < r.size(); ++i) pixels.emplace_back(r[i], g[i], b[i]);
  return pixels;
}

std::uint64_t spp_of(const ExrMetadata& metadata) {
  std::uint64_t spp = 2;
  const auto found = metadata.find("spp");
  if (found != metadata.end()) {
    std::from_chars(found->second.data(), found->second.data() + found->second.size(), spp);
  }
  return spp;
}

}  // namespace

ExrImage to_exr(const RadianceImage& image, ExrMetadata metadata) {
  ExrImage exr{image.width, image.height, {}, std::move(metadata)};
  exr.metadata["spp"] = std::to_string(image.samples);
  add_planes(exr, kMean, image.mean);
  add_planes(exr, kVariance, image.variance);
  return exr;
}

ExrImage to_exr(const FirstHitImage& image, ExrMetadata metadata) {
  ExrImage exr{image.width, image.height, {}, std::move(metadata)};
  add_planes(exr, kNormal, image.normal);
  add_planes(exr, kPosition, image.position);
  add_planes(exr, kAlbedo, image.albedo);
  add_planes(exr, kEmission, image.emission);
  return exr;
}

void add_filtered(ExrImage& exr, const RadianceImage& filtered) { add_planes(exr, kFiltered, filtered.mean); }

void add_halves(ExrImage& exr, const std::array<RadianceImage, 2>& halves) {
  add_planes(exr, kHalf1, halves[0].mean);
  add_planes(exr, kHalf2, halves[1].mean);
  exr.metadata["halves"] = fmt::format("half1: mean of the {} odd frames, half2: of the {} even ones",
                                       halves[0].samples, halves[1].samples);
}

RadianceImage to_radiance(const ExrImage& exr, const std::filesystem::path& file) {
  check(has_planes(exr, kMean), "{}: has no channels R, G, B", file.string());
  RadianceImage image;
  image.width = exr.width;
  image.height = exr.height;
  image.mean = get_planes(exr, kMean);
  if (has_planes(exr, kVariance)) {
    image.variance = get_planes(exr, kVariance);
    image.samples = spp_of(exr.metadata);
  } else {
    image.variance.assign(image.mean.size(), glm::dvec3(0.0));
  }
  return image;
}

}  // namespace qtrace::experiments
