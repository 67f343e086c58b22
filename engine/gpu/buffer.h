#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace qtrace::gpu {

// What the current context's device allows.
std::size_t most_buffer_bytes();

// Throws Error that names the buffer where the device allows none of this size.
void check_buffer_size(const std::string& name, std::size_t bytes);

// A buffer object with storage that never changes its size. `name` is what errors call it.
class Buffer {
 public:
  // Zeroed. Throws Error where the device does not allow or does not have so much.
  Buffer(std::string name, std::size_t bytes);
  template <class T>
  Buffer(std::string name, std::span<const T> data) : Buffer(std::move(name), data.size_bytes()) {
    if (!data.empty()) write(0, data.data(), data.size_bytes());
  }
  template <class T>
  Buffer(std::string name, const std::vector<T>& data) : Buffer(std::move(name), std::span<const T>(data)) {}
  ~Buffer();
  Buffer(Buffer&& other) noexcept;
  Buffer& operator=(Buffer&& other) noexcept;

  std::size_t bytes() const { return bytes_; }
  void bind_storage(int binding) const;
  void bind_uniform(int binding) const;
  void bind_dispatch() const;  // as the size of an indirect dispatch

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
  std::string name_;
  std::size_t bytes_ = 0;
  std::uint32_t id_ = 0;
};

}  // namespace qtrace::gpu
