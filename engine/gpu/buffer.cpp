#include "engine/gpu/buffer.h"

#include "engine/core/check.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <utility>

namespace qtrace::gpu {
namespace {

constexpr double kBytesPerMib = 1024.0 * 1024.0;
constexpr std::size_t kSmallest = 16;  // an empty scene part still needs something to bind
constexpr std::size_t kTexelBytes = 16;

}  // namespace

std::size_t most_buffer_bytes(BufferUse use) {
  GLint64 most = 0;
  const bool is_storage = use == BufferUse::storage;
  glGetInteger64v(is_storage ? GL_MAX_SHADER_STORAGE_BLOCK_SIZE : GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  return static_cast<std::size_t>(most) * (is_storage ? 1 : kTexelBytes);
}

void check_buffer_size(const std::string& name, std::size_t bytes, BufferUse use) {
  const std::size_t most = most_buffer_bytes(use);
  check(bytes <= most,
        "the buffer of {} needs {:.1f} MiB and this device allows {:.1f} MiB: reduce what it holds", name,
        static_cast<double>(bytes) / kBytesPerMib, static_cast<double>(most) / kBytesPerMib);
}

Buffer::Buffer(std::string name, std::size_t bytes, BufferUse use) : name_(std::move(name)), bytes_(bytes) {
  check_buffer_size(name_, bytes, use);
  glCreateBuffers(1, &id_);
  glNamedBufferStorage(id_, static_cast<GLsizeiptr>(std::max(bytes, kSmallest)), nullptr,
                       GL_DYNAMIC_STORAGE_BIT);
  if (glGetError() != GL_NO_ERROR) {
    glDeleteBuffers(1, &id_);
    fail("the device has no {:.1f} MiB left for the buffer of {}", static_cast<double>(bytes) / kBytesPerMib,
         name_);
  }
  clear();
  if (use == BufferUse::storage) return;
  glCreateTextures(GL_TEXTURE_BUFFER, 1, &texture_);
  glTextureBuffer(texture_, GL_RGBA32F, id_);
}

Buffer::~Buffer() {
  if (texture_ != 0) glDeleteTextures(1, &texture_);
  if (id_ != 0) glDeleteBuffers(1, &id_);
}

Buffer::Buffer(Buffer&& other) noexcept
    : name_(std::move(other.name_)),
      bytes_(other.bytes_),
      id_(std::exchange(other.id_, 0)),
      texture_(std::exchange(other.texture_, 0)) {}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  std::swap(name_, other.name_);
  std::swap(bytes_, other.bytes_);
  std::swap(id_, other.id_);
  std::swap(texture_, other.texture_);
  return *this;
}

void Buffer::bind_storage(int binding) const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(binding), id_);
}

void Buffer::bind_uniform(int binding) const {
  glBindBufferBase(GL_UNIFORM_BUFFER, static_cast<GLuint>(binding), id_);
}

void Buffer::bind_texels(int unit) const { glBindTextureUnit(static_cast<GLuint>(unit), texture_); }

void Buffer::bind_dispatch() const { glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, id_); }

void Buffer::clear() {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glClearNamedBufferData(id_, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

void Buffer::clear(std::size_t offset, std::size_t bytes) {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);

  glClearNamedBufferSubData(id_, GL_R32UI, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes),
                            GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

void Buffer::write(std::size_t offset, const void* data, std::size_t bytes) {
  check(offset + bytes <= bytes_, "write of {} bytes at {} outside of the buffer of {}", bytes, offset,
        name_);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glNamedBufferSubData(id_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

void Buffer::read(std::size_t offset, void* data, std::size_t bytes) const {
  check(offset + bytes <= bytes_, "read of {} bytes at {} outside of the buffer of {}", bytes, offset, name_);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(id_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

}  // namespace qtrace::gpu
