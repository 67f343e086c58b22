#include "engine/gpu/buffer.h"

#include "engine/core/check.h"
#include "engine/gpu/driver.h"
#include "engine/gpu/structs.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace qtrace::gpu {
namespace {

constexpr double kBytesPerMib = 1024.0 * 1024.0;
constexpr std::size_t kSmallest = 16;  // an empty scene part still needs something to bind

struct TexelFormat {
  GLenum format;
  std::size_t bytes;
};

TexelFormat format_of(Texels texels) {
  switch (texels) {
    case Texels::float1:
      return {GL_R32F, 4};
    case Texels::uint1:
      return {GL_R32UI, 4};
    case Texels::float4:
      return {GL_RGBA32F, 16};
    case Texels::uint4:
      return {GL_RGBA32UI, 16};
    case Texels::half4:
      return {GL_RGBA16F, 8};
    case Texels::none:
      break;
  }
  fail("a buffer without texels has no format");
}

std::size_t limit(GLenum name) {
  GLint64 most = 0;
  glGetInteger64v(name, &most);
  return static_cast<std::size_t>(most);
}

}  // namespace

std::size_t most_buffer_bytes(BufferUse use) {
  std::size_t most = std::numeric_limits<std::size_t>::max();
  if (use.storage || driver_choices().fetch == Fetch::storage) most = limit(GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
  if (use.texels == Texels::none) return most;
  return std::min(most, limit(GL_MAX_TEXTURE_BUFFER_SIZE) * format_of(use.texels).bytes);
}

void check_buffer_size(const std::string& name, std::size_t bytes, BufferUse use) {
  const std::size_t most = most_buffer_bytes(use);
  check(bytes <= most,
        "the buffer of {} needs {:.1f} MiB and this device allows {:.1f} MiB: reduce what it holds", name,
        static_cast<double>(bytes) / kBytesPerMib, static_cast<double>(most) / kBytesPerMib);
}

Buffer::Buffer(std::string name, std::size_t bytes, BufferUse use)
    : Buffer(std::move(name), nullptr, bytes, use) {}

Buffer::Buffer(std::string name, const void* data, std::size_t bytes, BufferUse use)
    : name_(std::move(name)), bytes_(bytes) {
  check_buffer_size(name_, bytes, use);
  texels_ = use.texels;
  glCreateBuffers(1, &id_);
  const bool is_given = data != nullptr && bytes >= kSmallest;
  glNamedBufferStorage(id_, static_cast<GLsizeiptr>(std::max(bytes, kSmallest)), is_given ? data : nullptr,
                       GL_DYNAMIC_STORAGE_BIT);
  if (glGetError() != GL_NO_ERROR) {
    glDeleteBuffers(1, &id_);
    fail("the device has no {:.1f} MiB left for the buffer of {}", static_cast<double>(bytes) / kBytesPerMib,
         name_);
  }
  if (!is_given) {
    clear();
    if (data != nullptr && bytes > 0) write(0, data, bytes);
  }
  if (use.texels == Texels::none) return;
  glCreateTextures(GL_TEXTURE_BUFFER, 1, &texture_);
  glTextureBuffer(texture_, format_of(use.texels).format, id_);
}

Buffer::~Buffer() {
  if (texture_ != 0) glDeleteTextures(1, &texture_);
  if (id_ != 0) glDeleteBuffers(1, &id_);
}

Buffer::Buffer(Buffer&& other) noexcept
    : name_(std::move(other.name_)),
      bytes_(other.bytes_),
      id_(std::exchange(other.id_, 0)),
      is_cleared_(other.is_cleared_),
      texels_(other.texels_),
      texture_(std::exchange(other.texture_, 0)) {}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  std::swap(name_, other.name_);
  std::swap(bytes_, other.bytes_);
  std::swap(id_, other.id_);
  std::swap(is_cleared_, other.is_cleared_);
  std::swap(texels_, other.texels_);
  std::swap(texture_, other.texture_);
  return *this;
}

void Buffer::bind_storage(int binding) const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(binding), id_);
}

void Buffer::bind_uniform(int binding) const {
  glBindBufferBase(GL_UNIFORM_BUFFER, static_cast<GLuint>(binding), id_);
}

void Buffer::bind_fetched(int unit) const {
  const auto slot = static_cast<GLuint>(unit);
  glBindTextureUnit(slot, texture_);
  // Drivers that have no more units fetch textures (fetch.cpp).
  if (slot < limit(GL_MAX_IMAGE_UNITS))
    glBindImageTexture(slot, texture_, 0, GL_FALSE, 0, GL_READ_ONLY, format_of(texels_).format);
  bind_storage(BINDING_FETCHED + unit);
}

void Buffer::bind_dispatch() const { glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, id_); }

void Buffer::clear() {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  is_cleared_ = true;
  glClearNamedBufferData(id_, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

void Buffer::clear(std::size_t offset, std::size_t bytes) {
  is_cleared_ = true;
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glClearNamedBufferSubData(id_, GL_R32UI, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes),
                            GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

void Buffer::write(std::size_t offset, const void* data, std::size_t bytes) {
  check(offset + bytes <= bytes_, "write of {} bytes at {} outside of the buffer of {}", bytes, offset,
        name_);
  // NVIDIA's driver (580.159) may write hundreds of kilobytes before it clears, where it was told the
  // opposite.
  if (std::exchange(is_cleared_, false)) glFinish();
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glNamedBufferSubData(id_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

void Buffer::read(std::size_t offset, void* data, std::size_t bytes) const {
  check(offset + bytes <= bytes_, "read of {} bytes at {} outside of the buffer of {}", bytes, offset, name_);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(id_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

}  // namespace qtrace::gpu
