#include "experiments/images/exr_picture.h"

#include "engine/core/check.h"
#include "experiments/files/atomic_file.h"
#include "experiments/images/colour.h"
#include "experiments/images/exr.h"
#include "experiments/images/exr_images.h"
#include "experiments/images/exr_layers.h"
#include "experiments/images/exr_planes.h"

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

#include <memory>
#include <optional>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<Imf::MultiPartInputFile> open(const fs::path& file) {
  check(is_file(file), "{}: no such file; an OpenEXR image is needed", file.string());
  try {
    return std::make_unique<Imf::MultiPartInputFile>(file.c_str());
  } catch (const std::exception& error) {
    fail("{}: cannot be read as an OpenEXR image: {}", file.string(), error.what());
  }
}

PixelBox box_of(const Imath::Box2i& window) {
  return {window.min.x, window.min.y, window.max.x, window.max.y};
}

// More than any primaries of light need; NaN, too, is not below it.
const glm::dvec3 kHugeWeight(1e6);

// Of the primaries' coordinates: those of Rec. 709 are written with three or four digits.
constexpr double kSamePrimaries = 5e-4;

// From the file's RGB to linear Rec. 709; nothing where it says that it has just that, or says nothing.
std::optional<glm::dmat3> to_rec709(const Imf::Header& header, const ExrLayer& layer) {
  const bool is_rgb = layer.kind == LayerKind::rgb || layer.kind == LayerKind::luminance_chroma;
  if (!is_rgb || !Imf::hasChromaticities(header)) return std::nullopt;
  const Imf::Chromaticities& said = Imf::chromaticities(header);
  const auto point = [](const Imath::V2f& v) { return glm::dvec2(v.x, v.y); };
  const Primaries file{point(said.red), point(said.green), point(said.blue), point(said.white)};
  const auto differs = [](const glm::dvec2& a, const glm::dvec2& b) {
    return !(glm::all(glm::lessThanEqual(glm::abs(a - b), glm::dvec2(kSamePrimaries))));
  };
  if (!differs(file.red, kRec709.red) && !differs(file.green, kRec709.green) &&
      !differs(file.blue, kRec709.blue) && !differs(file.white, kRec709.white)) {
    return std::nullopt;
  }
  const glm::dmat3 result = glm::inverse(rgb_to_xyz(kRec709)) * rgb_to_xyz(file);
  bool is_finite = true;
  for (int i = 0; i < 3; ++i)
    is_finite = is_finite && glm::all(glm::lessThan(glm::abs(result[i]), kHugeWeight));
  check(
      is_finite,
      "its chromaticities (red {:g} {:g}, green {:g} {:g}, blue {:g} {:g}, white {:g} {:g}) span no triangle "
      "of colours; those of Rec. 709 are 0.64 0.33, 0.3 0.6, 0.15 0.06, 0.3127 0.329",
      file.red.x, file.red.y, file.green.x, file.green.y, file.blue.x, file.blue.y, file.white.x,
      file.white.y);
  return result;
}

std::vector<std::string> variance_channels(const Imf::Header& header, const ExrLayer& layer) {
  // What becomes of a variance in other primaries depends on covariances, which no file has.
  if (layer.kind != LayerKind::rgb || layer.name != kRootLayer || to_rec709(header, layer)) return {};
  std::vector<std::string> names;
  for (const char* name : {"variance.R", "variance.G", "variance.B"}) {
    const Imf::Channel* channel = header.channels().findChannel(name);
    if (channel != nullptr && channel->type != Imf::UINT && channel->xSampling == 1 &&
        channel->ySampling == 1) {
      names.emplace_back(name);
    }
  }
  return names;
}

// Three planes under the names that to_radiance knows, whatever they are called in the file.
ExrImage read_planes(Imf::MultiPartInputFile& file, const ExrLayer& layer) {
  Imf::InputPart part(file, layer.part);
  const Imath::Box2i window = part.header().dataWindow();
  ExrImage exr{window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, {}, {}};
  const auto width = static_cast<std::size_t>(exr.width);
  Imf::FrameBuffer buffer;
  const auto add = [&](const std::string& channel, const std::string& name) {
    std::vector<float>& plane = exr.channels[name];
    plane.resize(width * static_cast<std::size_t>(exr.height));
    buffer.insert(channel, plane_slice(plane, window, width));
  };
  const std::vector<std::string> names{"R", "G", "B"};
  for (std::size_t i = 0; i < layer.channels.size(); ++i) add(layer.channels[i], names[i]);
  for (const std::string& name : variance_channels(part.header(), layer)) add(name, name);
  part.setFrameBuffer(buffer);
  part.readPixels(window.min.y, window.max.y);
  if (layer.channels.size() == 1) exr.channels["G"] = exr.channels["B"] = exr.channels.at("R");
  const auto* spp = part.header().findTypedAttribute<Imf::StringAttribute>("spp");
  if (spp != nullptr) exr.metadata["spp"] = spp->value();
  return exr;
}

// OpenEXR's own way from luminance and chroma to RGB, in 16-bit floats.
ExrImage read_chroma(const fs::path& file, const ExrLayer& layer) {
  check(layer.part == 0, "layer '{}' has luminance and chroma, which are read from the first part alone",
        layer.name);
  Imf::RgbaInputFile input(file.c_str(), layer.name == kRootLayer ? "" : layer.name);
  const Imath::Box2i window = input.dataWindow();
  ExrImage exr{window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, {}, {}};
  const auto width = static_cast<std::size_t>(exr.width);
  std::vector<Imf::Rgba> pixels(width * static_cast<std::size_t>(exr.height));
  const std::ptrdiff_t offset = window.min.x + window.min.y * static_cast<std::ptrdiff_t>(width);
  const auto base = reinterpret_cast<std::intptr_t>(pixels.data()) -
                    offset * static_cast<std::ptrdiff_t>(sizeof(Imf::Rgba));
  input.setFrameBuffer(reinterpret_cast<Imf::Rgba*>(base), 1, width);
  input.readPixels(window.min.y, window.max.y);
  for (const Imf::Rgba& pixel : pixels) {
    exr.channels["R"].push_back(pixel.r);
    exr.channels["G"].push_back(pixel.g);
    exr.channels["B"].push_back(pixel.b);
  }
  return exr;
}

std::string describe(const ExrLayer& layer) {
  const std::string names = fmt::format("{}", fmt::join(layer.channels, ", "));
  switch (layer.kind) {
    case LayerKind::rgb:
      return names;
    case LayerKind::xyz:
      return names + " (CIE XYZ, as linear Rec. 709)";
    case LayerKind::luminance:
      return names + " (as grey)";
    case LayerKind::luminance_chroma:
      return names + " with its chroma RY and BY (as RGB)";
    case LayerKind::vector:
      return names + " (as they stand)";
    case LayerKind::value:
      return names + " (as it stands)";
  }
  return names;
}

// What `use` makes of the file and its layer of this name. Throws Error that names the file.
template <class Use>
auto with_layer(const fs::path& file, const std::string& wanted, const Use& use) {
  const auto input = open(file);
  try {
    const LayerList list = list_layers(*input);
    const ExrLayer& layer = choose_layer(list, wanted);
    check_window(input->header(layer.part).dataWindow());
    return use(*input, layer);
  } catch (const Error& error) {
    fail("{}: {}", file.string(), error.what());
  } catch (const std::exception& error) {
    fail("{}: cannot be read as an OpenEXR image: {}", file.string(), error.what());
  }
}

}  // namespace

Picture read_picture(const fs::path& file, const std::string& wanted) {
  return with_layer(file, wanted, [&](Imf::MultiPartInputFile& input, const ExrLayer& layer) {
    check(input.partComplete(layer.part), "is truncated");
    const Imf::Header& header = input.header(layer.part);
    Picture picture;
    picture.image = to_radiance(
        layer.kind == LayerKind::luminance_chroma ? read_chroma(file, layer) : read_planes(input, layer),
        file);
    if (layer.kind == LayerKind::xyz) {
      const glm::dmat3 to_rgb = glm::inverse(kRec709ToXyz);
      for (glm::dvec3& pixel : picture.image.mean) pixel = to_rgb * pixel;
    }
    const auto converted = to_rec709(header, layer);
    if (converted) {
      for (glm::dvec3& pixel : picture.image.mean) pixel = *converted * pixel;
    }
    picture.data = box_of(header.dataWindow());
    picture.display = box_of(header.displayWindow());
    picture.layer = layer.name;
    picture.channels = describe(layer);
    if (converted) picture.channels += " (of the file's own primaries, as linear Rec. 709)";
    return picture;
  });
}

PictureFrame read_frame(const fs::path& file, const std::string& wanted) {
  return with_layer(file, wanted, [](Imf::MultiPartInputFile& input, const ExrLayer& layer) {
    const Imf::Header& header = input.header(layer.part);
    return PictureFrame{box_of(header.dataWindow()), box_of(header.displayWindow())};
  });
}

bool has_layer(const fs::path& file, const std::string& layer) {
  return !layers_named(list_layers(*open(file)), layer).empty();
}

RadianceImage crop(const Picture& picture, const PixelBox& box) {
  if (box == picture.data) return picture.image;
  RadianceImage part{box.width(), box.height(), picture.image.samples, {}, {}};
  for (int y = box.top; y <= box.bottom; ++y) {
    for (int x = box.left; x <= box.right; ++x) {
      const auto i =
          static_cast<std::size_t>(y - picture.data.top) * static_cast<std::size_t>(picture.image.width) +
          static_cast<std::size_t>(x - picture.data.left);
      part.mean.push_back(picture.image.mean[i]);
      part.variance.push_back(picture.image.variance[i]);
    }
  }
  return part;
}

}  // namespace qtrace::experiments
