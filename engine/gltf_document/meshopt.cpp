#include "engine/gltf_document/meshopt.h"

#include "engine/gltf_document/usage.h"

#include <meshoptimizer.h>

#include <cstdint>

namespace qtrace::gltf {
namespace {

using nlohmann::json;

// The library asserts what follows from the extension's text and says no more than that decoding failed.
class Decoder {
 public:
  Decoder(const Source& source, std::string place, const json& extension,
          std::span<const unsigned char> bytes)
      : source_(source),
        place_(std::move(place)),
        bytes_(bytes),
        count_(extension.at("count").get<std::size_t>()),
        stride_(extension.at("byteStride").get<std::size_t>()),
        mode_(extension.at("mode").get<std::string>()),
        filter_(extension.value("filter", "NONE")) {}

  // Of what is decoded; Error where it would be more than `most`.
  std::size_t size(std::size_t most) const {
    const bool are_vertices = mode_ == "ATTRIBUTES";
    const bool fits =
        are_vertices ? stride_ % 4 == 0 && stride_ >= 4 && stride_ <= 256 : stride_ == 2 || stride_ == 4;
    source_.check(fits, "{}: byteStride is {} with mode {}; {} would be right", place_, stride_, mode_,
                  are_vertices ? "a multiple of 4 from 4 to 256" : "2 or 4");
    source_.check(mode_ != "TRIANGLES" || count_ % 3 == 0, "{}: count is {}; a multiple of 3 would be right",
                  place_, count_);
    source_.check(count_ > 0 && count_ <= most / stride_,
                  "{}: count is {}; 1 or more, and no more than {} bytes in all, would be right", place_,
                  count_, most);
    return count_ * stride_;
  }

  std::vector<unsigned char> decoded(std::size_t size) const {
    std::vector<unsigned char> result(size);
    source_.check(decode(result.data()) == 0, "{}: its {} bytes cannot be decoded as {} {} of {} bytes",
                  place_, bytes_.size(), count_, mode_, stride_);
    apply_filter(result.data());
    return result;
  }

 private:
  int decode(unsigned char* to) const {
    if (mode_ == "ATTRIBUTES")
      return meshopt_decodeVertexBuffer(to, count_, stride_, bytes_.data(), bytes_.size());
    if (mode_ == "TRIANGLES")
      return meshopt_decodeIndexBuffer(to, count_, stride_, bytes_.data(), bytes_.size());
    return meshopt_decodeIndexSequence(to, count_, stride_, bytes_.data(), bytes_.size());
  }

  void apply_filter(unsigned char* values) const {
    if (filter_ == "NONE") return;
    const auto expect = [this](bool fits, const char* right) {
      source_.check(fits && mode_ == "ATTRIBUTES",
                    "{}: filter {} with byteStride {} and mode {}; {} would be right", place_, filter_,
                    stride_, mode_, right);
    };
    if (filter_ == "OCTAHEDRAL") {
      expect(stride_ == 4 || stride_ == 8, "4 or 8 with ATTRIBUTES");
      meshopt_decodeFilterOct(values, count_, stride_);
    } else if (filter_ == "QUATERNION") {
      expect(stride_ == 8, "8 with ATTRIBUTES");
      meshopt_decodeFilterQuat(values, count_, stride_);
    } else if (filter_ == "COLOR") {
      source_.fail(
          "{}: filter COLOR is not supported; NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL would be right",
          place_);
    } else {
      expect(true, "ATTRIBUTES");
      meshopt_decodeFilterExp(values, count_, stride_);
    }
  }

  const Source& source_;
  std::string place_;
  std::span<const unsigned char> bytes_;
  std::size_t count_, stride_;
  std::string mode_, filter_;
};

std::span<const unsigned char> compressed_bytes(const Source& source, const json& extension,
                                                const std::string& place,
                                                const std::vector<tinygltf::Buffer>& buffers) {
  const auto offset = extension.value("byteOffset", std::size_t{0});
  const auto length = extension.at("byteLength").get<std::size_t>();
  const auto buffer = extension.at("buffer").get<std::size_t>();
  const std::vector<unsigned char>& bytes = buffers.at(buffer).data;
  source.check(offset <= bytes.size() && length <= bytes.size() - offset,
               "{} covers {} bytes from byte {}, and buffer {} has {}", place, length, offset, buffer,
               bytes.size());
  return std::span(bytes).subspan(offset, length);
}

}  // namespace

void decode_meshopt(const Source& source, json& document, std::vector<tinygltf::Buffer>& buffers,
                    std::size_t max_bytes) {
  std::size_t rest = max_bytes;
  for (const std::size_t i : used_views(document)) {
    json& view = document["bufferViews"][i];
    const char* name = nullptr;
    const json* found = meshopt_of(view, &name);
    if (found == nullptr) continue;
    const std::string place = fmt::format("bufferView {} {}", i, name);
    const json extension = *found;
    const Decoder decoder(source, place, extension, compressed_bytes(source, extension, place, buffers));
    const std::size_t size = decoder.size(rest);
    rest -= size;
    view["buffer"] = buffers.size();
    view["byteOffset"] = 0;
    view["byteLength"] = size;
    view.erase("extensions");
    std::vector<unsigned char> bytes = decoder.decoded(size);
    buffers.emplace_back().data = std::move(bytes);
  }
}

}  // namespace qtrace::gltf
