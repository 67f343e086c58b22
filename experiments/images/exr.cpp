#include "experiments/images/exr.h"

#include "engine/core/check.h"
#include "experiments/files/atomic_file.h"
#include "experiments/images/exr_planes.h"

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

namespace qtrace::experiments {
namespace {

ExrImage read_planes(const std::filesystem::path& file) {
  Imf::InputFile input(file.c_str());
  check(input.isComplete(), "the file is truncated");
  const Imf::Header& header = input.header();
  const Imath::Box2i window = header.dataWindow();
  check_window(window);
  ExrImage image;
  image.width = window.max.x - window.min.x + 1;
  image.height = window.max.y - window.min.y + 1;
  const auto width = static_cast<std::size_t>(image.width);
  Imf::FrameBuffer buffer;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    if (channel.channel().type == Imf::UINT) continue;
    check(channel.channel().xSampling == 1 && channel.channel().ySampling == 1,
          "channel '{}' is subsampled; only full resolution is read", channel.name());
    std::vector<float>& plane = image.channels[channel.name()];
    plane.resize(width * static_cast<std::size_t>(image.height));
    buffer.insert(channel.name(), plane_slice(plane, window, width));
  }
  for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute());
    if (text != nullptr) image.metadata[attribute.name()] = text->value();
  }
  input.setFrameBuffer(buffer);
  input.readPixels(window.min.y, window.max.y);
  return image;
}

}  // namespace

void write_exr_planes(const std::filesystem::path& file, const ExrImage& image) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const auto& [key, text] : image.metadata) header.insert(key, Imf::StringAttribute(text));
  Imf::FrameBuffer buffer;
  ExrImage copy = image;  // OpenEXR takes writable memory even for output
  for (auto& [name, plane] : copy.channels) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    buffer.insert(name, plane_slice(plane, header.dataWindow(), static_cast<std::size_t>(image.width)));
  }
  Imf::OutputFile output(file.c_str(), header);
  output.setFrameBuffer(buffer);
  output.writePixels(image.height);
}

void write_exr(const std::filesystem::path& file, const ExrImage& image) {
  AtomicFile target(file);
  try {
    write_exr_planes(target.temporary(), image);
  } catch (const std::exception& error) {
    fail_to_write(file, error.what());
  }
  target.commit();
}

ExrImage read_exr(const std::filesystem::path& file) {
  check(is_file(file), "{}: no such file; an OpenEXR image is needed", file.string());
  try {
    return read_planes(file);
  } catch (const std::exception& error) {
    fail("{}: cannot be read as an OpenEXR image: {}", file.string(), error.what());
  }
}

}  // namespace qtrace::experiments
