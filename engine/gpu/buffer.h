#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace qtrace::gpu {

// Elements of a buffer that shaders fetch one by one (shaders/shared/fetch.glsl).
enum class Texels { none, float1, uint1, float4, uint4, half4 };

// llvmpipe allows 128 MiB of storage, and 2^27 texels.
struct BufferUse {
  bool storage = true;  // shaders read and write it as a block
  Texels texels = Texels::none;
};
constexpr BufferUse only_fetched(Texels texels) { return {false, texels}; }
constexpr BufferUse also_fetched(Texels texels) { return {true, texels}; }

// What the current context's device allows.
std::size_t most_buffer_bytes(BufferUse use = {});

// Throws Error that names the buffer where the device allows none of this size.
void check_buffer_size(const std::string& name, std::size_t bytes, BufferUse use = {});

// A buffer object with storage that never changes its size. `name` is what errors call it.
class Buffer {
 public:
  // Zeroed. Throws Error where the device does not allow or does not have so much.
  Buffer(std::string name, std::size_t bytes, BufferUse use = {});
  template <class T>
  Buffer(std::string name, std::span<const T> data, BufferUse use = {})
      : Buffer(std::move(name), data.data(), data.size_bytes(), use) {}
  template <class T>
  Buffer(std::string name, const std::vector<T>& data, BufferUse use = {})
      : Buffer(std::move(name), std::span<const T>(data), use) {}
  ~Buffer();
  Buffer(Buffer&& other) noexcept;
  Buffer& operator=(Buffer&& other) noexcept;

  const std::string& name() const { return name_; }
  std::size_t bytes() const { return bytes_; }
  void bind_storage(int binding) const;
  void bind_uniform(int binding) const;
  void bind_fetched(int unit) const;  // in every way that fetch.glsl knows
  void bind_dispatch() const;         // as the size of an indirect dispatch

  void clear();
  void clear(std::size_t offset, std::size_t bytes);  // multiples of 4
  void write(std::size_t offset, const void* data, std::size_t bytes);
  void read(std::size_t offset, void* data, std::size_t bytes) const;  // waits

  template <class T>
  std::vector<T> read_all() const {
    std::vector<T> data(bytes_ / sizeof(T));
    read(0, data.data(), data.size() * sizeof(T));
    return data;
  }

 private:
  // Of these bytes; zeroed where `data` is null or `bytes` 0.
  Buffer(std::string name, const void* data, std::size_t bytes, BufferUse use);

  std::string name_;
  std::size_t bytes_ = 0;
  std::uint32_t id_ = 0;
  bool is_cleared_ = false;  // since it was last written by the host
  Texels texels_ = Texels::none;
  std::uint32_t texture_ = 0;  // of the texels
};

}  // namespace qtrace::gpu
