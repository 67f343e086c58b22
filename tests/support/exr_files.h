// Writes OpenEXR files as other programs do, with OpenEXR itself.
#pragma once

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledOutputFile.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace qtrace::tests {

// The pixel (x, y) of the file has `value` + 10 x + 100 y, which 16 bits hold exactly for a few pixels.
struct TestChannel {
  std::string name;
  double value;
  Imf::PixelType type = Imf::FLOAT;
};

struct TestPart {
  std::vector<TestChannel> channels;
  std::string name;
  Imath::Box2i data{{0, 0}, {2, 1}};
  Imath::Box2i display{{0, 0}, {2, 1}};
  std::optional<Imf::Chromaticities> chromaticities{};
};

// Planes in the type of each channel, and a frame buffer of them.
class PartPixels {
 public:
  explicit PartPixels(const TestPart& part) {
    for (const TestChannel& channel : part.channels) add(channel, part.data);
  }
  const Imf::FrameBuffer& buffer() const { return buffer_; }

 private:
  void add(const TestChannel& channel, const Imath::Box2i& box) {
    const std::size_t size = channel.type == Imf::HALF ? 2 : 4;
    const auto width = static_cast<std::size_t>(box.max.x - box.min.x + 1);
    auto bytes = std::make_unique<std::vector<char>>();
    for (int y = box.min.y; y <= box.max.y; ++y) {
      for (int x = box.min.x; x <= box.max.x; ++x) {
        const float value = static_cast<float>(channel.value + 10 * x + 100 * y);
        const Imath::half half(value);
        const auto whole = static_cast<std::uint32_t>(value);
        const void* from = &value;
        if (channel.type == Imf::HALF) from = &half;
        if (channel.type == Imf::UINT) from = &whole;
        bytes->insert(bytes->end(), static_cast<const char*>(from), static_cast<const char*>(from) + size);
      }
    }
    const auto base =
        reinterpret_cast<std::intptr_t>(bytes->data()) -
        (box.min.x + box.min.y * static_cast<std::ptrdiff_t>(width)) * static_cast<std::ptrdiff_t>(size);
    buffer_.insert(channel.name, Imf::Slice(channel.type, reinterpret_cast<char*>(base), size, width * size));
    planes_.push_back(std::move(bytes));
  }

  Imf::FrameBuffer buffer_;
  std::vector<std::unique_ptr<std::vector<char>>> planes_;
};

inline Imf::Header header_of(const TestPart& part) {
  Imf::Header header(part.display, part.data);
  for (const TestChannel& channel : part.channels)
    header.channels().insert(channel.name, Imf::Channel(channel.type));
  if (!part.name.empty()) header.setName(part.name);
  if (part.chromaticities) Imf::addChromaticities(header, *part.chromaticities);
  return header;
}

inline void write_scan_lines(const std::filesystem::path& file, const TestPart& part) {
  const PartPixels pixels(part);
  Imf::OutputFile output(file.c_str(), header_of(part));
  output.setFrameBuffer(pixels.buffer());
  output.writePixels(part.data.max.y - part.data.min.y + 1);
}

inline void write_tiles(const std::filesystem::path& file, const TestPart& part) {
  const PartPixels pixels(part);
  Imf::Header header = header_of(part);
  header.setTileDescription(Imf::TileDescription(2, 2, Imf::ONE_LEVEL));
  Imf::TiledOutputFile output(file.c_str(), header);
  output.setFrameBuffer(pixels.buffer());
  output.writeTiles(0, output.numXTiles() - 1, 0, output.numYTiles() - 1);
}

inline void write_parts(const std::filesystem::path& file, const std::vector<TestPart>& parts) {
  std::vector<Imf::Header> headers;
  for (const TestPart& part : parts) {
    headers.push_back(header_of(part));
    headers.back().setType(Imf::SCANLINEIMAGE);
  }
  Imf::MultiPartOutputFile output(file.c_str(), headers.data(), static_cast<int>(headers.size()));
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const PartPixels pixels(parts[i]);
    Imf::OutputPart part(output, static_cast<int>(i));
    part.setFrameBuffer(pixels.buffer());
    part.writePixels(parts[i].data.max.y - parts[i].data.min.y + 1);
  }
}

}  // namespace qtrace::tests
