// Content hashes: XXH3 with 128 bits, as 32 hexadecimal digits.
#pragma once

#include <xxhash.h>

#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace qtrace::experiments {

std::string hash_text(std::string_view text);

// A hash of values in the order in which they are added.
class Hasher {
 public:
  Hasher();

  // The bytes of values that have no padding.
  template <class T>
  void add(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    XXH3_128bits_update(state_.get(), &value, sizeof(T));
  }

  // The bytes of many such values, and how many they are.
  template <class T>
  void add_all(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    add(values.size());
    XXH3_128bits_update(state_.get(), values.data(), values.size() * sizeof(T));
  }

  // Of a member that came after hashes of its struct had been kept: `implied` is what programs without it
  // did. With that value it leaves no trace, so that what was kept is found again.
  template <class T>
  void add_later(std::string_view name, const T& value, const T& implied) {
    if (value == implied) return;
    for (const char c : name) add(c);
    add(value);
  }
  std::string digest() const;

 private:
  std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state_;
};

}  // namespace qtrace::experiments
