#include "engine/gltf_document/expansion.h"

#include "engine/gltf_document/usage.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>

namespace qtrace::gltf {
namespace {

using nlohmann::json;

std::size_t number(const json& object, const char* name) {
  const auto found = object.find(name);
  return found == object.end() ? 0 : found->get<std::size_t>();
}

std::size_t component_size(const json& accessor) {
  return static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(accessor.at("componentType").get<std::uint32_t>()));
}

std::size_t element_size(const json& accessor) {
  const auto type = accessor.at("type").get<std::string>();
  const std::size_t n = type.starts_with("MAT")
                            ? static_cast<std::size_t>((type.back() - '0') * (type.back() - '0'))
                        : type.starts_with("VEC") ? static_cast<std::size_t>(type.back() - '0')
                                                  : 1;
  return n * component_size(accessor);
}

// `count` elements of a bufferView from `offset` on, `stride` bytes apart.
struct Elements {
  const unsigned char* first = nullptr;
  std::size_t stride = 0;
};

Elements elements(const Source& source, std::span<const unsigned char> bytes, std::size_t offset,
                  std::size_t count, std::size_t size, std::size_t stride, const std::string& what) {
  const std::size_t space = bytes.size() - std::min(offset, bytes.size());
  const std::size_t room = space < size ? 0 : (space - size) / stride + 1;
  source.check(stride >= size, "{}: a byteStride of {}; {} or more would be right", what, stride, size);
  source.check(count <= room, "{} has {} elements from byte {}, and its bufferView has room for {}", what,
               count, offset, room);
  return {bytes.data() + offset, stride};
}

std::uint64_t index_at(const Elements& indices, std::size_t i, std::size_t size) {
  std::uint64_t value = 0;  // little-endian, as glTF and the machine are
  std::memcpy(&value, indices.first + i * indices.stride, size);
  return value;
}

class Expansion {
 public:
  Expansion(const Source& source, json& document, std::vector<tinygltf::Buffer>& buffers,
            std::size_t max_bytes)
      : source_(source), document_(document), buffers_(buffers), max_bytes_(max_bytes), rest_(max_bytes) {}

  void expand(std::size_t index) {
    json& accessor = document_["accessors"][index];
    const bool is_sparse = accessor.contains("sparse");
    if (!is_sparse && accessor.contains("bufferView")) return;
    place_ = fmt::format("accessor {}", index);
    size_ = element_size(accessor);
    count_ = number(accessor, "count");
    source_.check(count_ > 0, "{} has a count of 0; 1 or more would be right", place_);
    source_.check(count_ <= rest_ / size_,
                  "{}: accessors that are sparse or have no bufferView ask for more than {} bytes, "
                  "which is the most supported",
                  place_, max_bytes_);
    rest_ -= count_ * size_;
    std::vector<unsigned char> bytes(count_ * size_);
    if (accessor.contains("bufferView")) copy_base(accessor, bytes);
    if (is_sparse) put_elements(accessor["sparse"], bytes);
    accessor.erase("sparse");
    accessor.erase("byteOffset");
    accessor["bufferView"] = add_view(document_, buffers_, std::move(bytes));
  }

 private:
  std::span<const unsigned char> bytes_of(const json& object) const {
    return view_bytes(source_, document_, buffers_, number(object, "bufferView"));
  }

  void copy_base(const json& accessor, std::vector<unsigned char>& bytes) const {
    const std::size_t stride = number(document_["bufferViews"][number(accessor, "bufferView")], "byteStride");
    const Elements base = elements(source_, bytes_of(accessor), number(accessor, "byteOffset"), count_, size_,
                                   stride == 0 ? size_ : stride, place_);
    for (std::size_t i = 0; i < count_; ++i)
      std::memcpy(bytes.data() + i * size_, base.first + i * base.stride, size_);
  }

  void put_elements(const json& sparse, std::vector<unsigned char>& bytes) const {
    const std::size_t count = number(sparse, "count");
    source_.check(count > 0 && count <= count_,
                  "{}: its sparse.count is {}; 1 to {}, its count, would be right", place_, count, count_);
    const std::size_t index_size = component_size(sparse["indices"]);
    const Elements indices =
        elements(source_, bytes_of(sparse["indices"]), number(sparse["indices"], "byteOffset"), count,
                 index_size, index_size, place_ + " sparse.indices");
    const Elements values =
        elements(source_, bytes_of(sparse["values"]), number(sparse["values"], "byteOffset"), count, size_,
                 size_, place_ + " sparse.values");
    std::optional<std::uint64_t> last;
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint64_t at = index_at(indices, i, index_size);
      source_.check(at < count_ && (!last || at > *last),
                    "{} sparse.indices: element {} is {}; indices below {} that grow would be right", place_,
                    i, at, count_);
      std::memcpy(bytes.data() + at * size_, values.first + i * size_, size_);
      last = at;
    }
  }

  const Source& source_;
  json& document_;
  std::vector<tinygltf::Buffer>& buffers_;
  std::size_t max_bytes_, rest_;
  std::string place_;  // of the accessor at hand, as its size in bytes per element, and its count
  std::size_t size_ = 0, count_ = 0;
};

}  // namespace

std::span<const unsigned char> view_bytes(const Source& source, const json& document,
                                          const std::vector<tinygltf::Buffer>& buffers, std::size_t index) {
  const json& view = document.at("bufferViews").at(index);
  const std::size_t buffer = number(view, "buffer"), offset = number(view, "byteOffset"),
                    length = number(view, "byteLength");
  const std::vector<unsigned char>& bytes = buffers.at(buffer).data;
  source.check(offset <= bytes.size() && length <= bytes.size() - offset,
               "bufferView {} covers {} bytes from byte {}, and buffer {} has {}", index, length, offset,
               buffer, bytes.size());
  return std::span(bytes).subspan(offset, length);
}

std::size_t add_view(json& document, std::vector<tinygltf::Buffer>& buffers,
                     std::vector<unsigned char> bytes) {
  json& views = document["bufferViews"];
  if (views.is_null()) views = json::array();
  views.push_back({{"buffer", buffers.size()}, {"byteOffset", 0}, {"byteLength", bytes.size()}});
  buffers.emplace_back().data = std::move(bytes);
  return views.size() - 1;
}

void expand_accessors(const Source& source, json& document, std::vector<tinygltf::Buffer>& buffers,
                      std::size_t max_bytes) {
  Expansion expansion(source, document, buffers, max_bytes);
  for (const std::size_t index : used_accessors(document)) expansion.expand(index);
}

}  // namespace qtrace::gltf
