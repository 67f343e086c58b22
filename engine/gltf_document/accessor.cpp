#include "engine/gltf_document/accessor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace qtrace::gltf {
namespace {

constexpr int kFloat = TINYGLTF_COMPONENT_TYPE_FLOAT, kByte = TINYGLTF_COMPONENT_TYPE_BYTE,
              kUnsignedByte = TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, kShort = TINYGLTF_COMPONENT_TYPE_SHORT,
              kUnsignedShort = TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
              kUnsignedInt = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;

constexpr Component kPosition[]{{kFloat, false},        {kByte, false},          {kByte, true},
                                {kUnsignedByte, false}, {kUnsignedByte, true},   {kShort, false},
                                {kShort, true},         {kUnsignedShort, false}, {kUnsignedShort, true}};
constexpr Component kNormal[]{{kFloat, false}, {kByte, true}, {kShort, true}};
constexpr Component kFloats[]{{kFloat, false}};
constexpr Component kJoints[]{{kUnsignedByte, false}, {kUnsignedShort, false}};
constexpr Component kWeights[]{{kFloat, false}, {kUnsignedByte, true}, {kUnsignedShort, true}};
constexpr Component kIndex[]{{kUnsignedByte, false}, {kUnsignedShort, false}, {kUnsignedInt, false}};

std::string_view type_name(int type) {
  switch (type) {
    case TINYGLTF_TYPE_SCALAR:
      return "SCALAR";
    case TINYGLTF_TYPE_VEC2:
      return "VEC2";
    case TINYGLTF_TYPE_VEC3:
      return "VEC3";
    case TINYGLTF_TYPE_VEC4:
      return "VEC4";
    default:
      return "a matrix";
  }
}

void check_layout(const Source& source, const tinygltf::Accessor& accessor, const Layout& layout,
                  const std::string& role) {
  // That floats are normalized would say nothing.
  const Component found{accessor.componentType, accessor.normalized && accessor.componentType != kFloat};
  const bool fits = accessor.type == layout.type && std::ranges::count(layout.components, found) > 0;
  source.check(fits, "{} has the wrong type ({} of component type {}{}); {} would be right", role,
               type_name(accessor.type), accessor.componentType, accessor.normalized ? ", normalized" : "",
               layout.text);
}

// Sizes come from the file, so sums may overflow: each check subtracts from what is known to be there.
void check_view(const Source& source, const tinygltf::BufferView& view, int index) {
  const std::size_t size = source.model.buffers[static_cast<std::size_t>(view.buffer)].data.size();
  source.check(view.byteOffset <= size && view.byteLength <= size - view.byteOffset,
               "bufferView {} covers {} bytes from byte {}, and buffer {} has {}", index, view.byteLength,
               view.byteOffset, view.buffer, size);
}

void check_extent(const Source& source, const tinygltf::Accessor& accessor, const tinygltf::BufferView& view,
                  std::size_t element, std::size_t stride, const std::string& role) {
  source.check(stride >= element, "{}: bufferView {} has a byteStride of {}; {} or more would be right", role,
               accessor.bufferView, stride, element);
  source.check(accessor.count > 0, "{} has a count of 0; 1 or more would be right", role);
  const std::size_t offset = std::min(accessor.byteOffset, view.byteLength);
  const std::size_t space = view.byteLength - offset;
  const std::size_t room = space < element ? 0 : (space - element) / stride + 1;
  source.check(accessor.count <= room, "{} has {} elements from byte {}, and bufferView {} has room for {}",
               role, accessor.count, accessor.byteOffset, accessor.bufferView, room);
}

}  // namespace

const Layout kPositionLayout{TINYGLTF_TYPE_VEC3, kPosition, "VEC3 of float, or of bytes or shorts"};
const Layout kNormalLayout{TINYGLTF_TYPE_VEC3, kNormal, "VEC3 of float, or of normalized bytes or shorts"};
const Layout kUvLayout{TINYGLTF_TYPE_VEC2, kPosition, "VEC2 of float, or of bytes or shorts"};
const Layout kTangentLayout{TINYGLTF_TYPE_VEC4, kNormal, "VEC4 of float, or of normalized bytes or shorts"};
const Layout kColor3Layout{TINYGLTF_TYPE_VEC3, kWeights,
                           "VEC3 or VEC4 of float, or of normalized unsigned bytes or shorts"};
const Layout kColor4Layout{TINYGLTF_TYPE_VEC4, kWeights, kColor3Layout.text};
const Layout kRotationLayout{TINYGLTF_TYPE_VEC4, kNormal, "VEC4 of float, or of normalized bytes or shorts"};
const Layout kJointsLayout{TINYGLTF_TYPE_VEC4, kJoints, "VEC4 of unsigned bytes or shorts"};
const Layout kWeightsLayout{TINYGLTF_TYPE_VEC4, kWeights,
                            "VEC4 of float, or of normalized unsigned bytes or shorts"};
const Layout kMatrixLayout{TINYGLTF_TYPE_MAT4, kFloats, "MAT4 of float"};
const Layout kIndexLayout{TINYGLTF_TYPE_SCALAR, kIndex, "SCALAR of unsigned bytes, shorts or ints"};

AccessorView::AccessorView(const Source& source, int accessor_index, const Layout& layout,
                           const std::string& role)
    : role_(fmt::format("{} (accessor {})", role, accessor_index)) {
  const tinygltf::Accessor& accessor = source.model.accessors.at(static_cast<std::size_t>(accessor_index));
  const tinygltf::BufferView& view =
      source.model.bufferViews.at(static_cast<std::size_t>(accessor.bufferView));
  check_layout(source, accessor, layout, role_);
  check_view(source, view, accessor.bufferView);
  const auto component_size =
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
  const auto components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
  const auto element = static_cast<std::size_t>(component_size * components);
  stride_ = view.byteStride == 0 ? element : view.byteStride;
  check_extent(source, accessor, view, element, stride_, role_);
  data_ = source.model.buffers[static_cast<std::size_t>(view.buffer)].data.data() + view.byteOffset +
          accessor.byteOffset;
  count_ = accessor.count;
  component_type_ = accessor.componentType;
  is_normalized_ = accessor.normalized;
}

template <class T>
T AccessorView::component(std::size_t i, std::size_t component) const {
  T value;
  std::memcpy(&value, data_ + i * stride_ + component * sizeof(T), sizeof(T));
  return value;
}

// glTF 2.0, section 3.6.2.2: c / 127 and the like, and no less than -1.
template <class T>
float AccessorView::fraction(std::size_t i, std::size_t k) const {
  const auto value = static_cast<float>(component<T>(i, k));
  return is_normalized_ ? std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0F) : value;
}

float AccessorView::number(std::size_t i, std::size_t k) const {
  switch (component_type_) {
    case kByte:
      return fraction<std::int8_t>(i, k);
    case kUnsignedByte:
      return fraction<std::uint8_t>(i, k);
    case kShort:
      return fraction<std::int16_t>(i, k);
    case kUnsignedShort:
      return fraction<std::uint16_t>(i, k);
    default:
      return component<float>(i, k);
  }
}

void AccessorView::numbers(const Source& source, std::size_t i, std::span<float> values) const {
  bool are_finite = true;
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = number(i, k);
    are_finite = are_finite && std::isfinite(values[k]);
  }
  if (are_finite) return;
  std::string text;
  for (const float value : values) text += fmt::format("{}{}", text.empty() ? "" : ", ", value);
  source.fail("{}: element {} is ({}); finite numbers would be right", role_, i, text);
}

glm::vec3 AccessorView::vec3(const Source& source, std::size_t i) const {
  glm::vec3 value;
  numbers(source, i, {&value[0], 3});
  return value;
}

glm::vec2 AccessorView::vec2(const Source& source, std::size_t i) const {
  glm::vec2 value;
  numbers(source, i, {&value[0], 2});
  return value;
}

glm::vec4 AccessorView::vec4(const Source& source, std::size_t i) const {
  glm::vec4 value;
  numbers(source, i, {&value[0], 4});
  return value;
}

glm::mat4 AccessorView::mat4(const Source& source, std::size_t i) const {
  glm::mat4 value;
  numbers(source, i, {&value[0][0], 16});
  return value;
}

std::uint32_t AccessorView::index(std::size_t i) const {
  switch (component_type_) {
    case kUnsignedByte:
      return component<std::uint8_t>(i, 0);
    case kUnsignedShort:
      return component<std::uint16_t>(i, 0);
    default:
      return component<std::uint32_t>(i, 0);
  }
}

std::uint32_t AccessorView::restart_value() const {
  switch (component_type_) {
    case kUnsignedByte:
      return std::numeric_limits<std::uint8_t>::max();
    case kUnsignedShort:
      return std::numeric_limits<std::uint16_t>::max();
    default:
      return std::numeric_limits<std::uint32_t>::max();
  }
}

}  // namespace qtrace::gltf
