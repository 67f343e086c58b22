// The members of an aggregate without their names, so that a test goes through all of them and none that is
// added later is left out.
#pragma once

#include <concepts>
#include <cstddef>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

namespace qtrace::test {

// Converts to the type of any member; never evaluated.
struct AnyMember {
  template <class T>
  operator T() const;  // NOLINT: implicit, that is the point
};

// How many values T takes between braces.
template <class T, class... Values>
constexpr std::size_t member_count() {
  if constexpr (requires { T{Values{}..., AnyMember{}}; }) {
    return member_count<T, Values..., AnyMember>();
  } else {
    return sizeof...(Values);
  }
}

// References to all members, in their order. A structure of more members needs one more line.
template <class T>
auto members(T& t) {
  constexpr std::size_t kCount = member_count<std::remove_const_t<T>>();
  static_assert(kCount >= 2 && kCount <= 16);
  // clang-format off
  if constexpr (kCount == 2) { auto& [a, b] = t; return std::tie(a, b); }
  else if constexpr (kCount == 3) { auto& [a, b, c] = t; return std::tie(a, b, c); }
  else if constexpr (kCount == 4) { auto& [a, b, c, d] = t; return std::tie(a, b, c, d); }
  else if constexpr (kCount == 5) { auto& [a, b, c, d, e] = t; return std::tie(a, b, c, d, e); }
  else if constexpr (kCount == 6) { auto& [a, b, c, d, e, f] = t; return std::tie(a, b, c, d, e, f); }
  else if constexpr (kCount == 7) { auto& [a, b, c, d, e, f, g] = t; return std::tie(a, b, c, d, e, f, g); }
  else if constexpr (kCount == 8) { auto& [a, b, c, d, e, f, g, h] = t; return std::tie(a, b, c, d, e, f, g, h); }
  else if constexpr (kCount == 9) { auto& [a, b, c, d, e, f, g, h, i] = t; return std::tie(a, b, c, d, e, f, g, h, i); }
  else if constexpr (kCount == 10) { auto& [a, b, c, d, e, f, g, h, i, j] = t; return std::tie(a, b, c, d, e, f, g, h, i, j); }
  else if constexpr (kCount == 11) { auto& [a, b, c, d, e, f, g, h, i, j, k] = t; return std::tie(a, b, c, d, e, f, g, h, i, j, k); }
  else if constexpr (kCount == 12) { auto& [a, b, c, d, e, f, g, h, i, j, k, l] = t; return std::tie(a, b, c, d, e, f, g, h, i, j, k, l); }
  else if constexpr (kCount == 13) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = t; return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m); }
  else if constexpr (kCount == 14) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n] = t; return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, n); }
  else if constexpr (kCount == 15) { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o] = t; return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o); }
  else { auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = t; return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p); }
  // clang-format on
}

template <class T>
constexpr bool is_optional = false;
template <class T>
constexpr bool is_optional<std::optional<T>> = true;
template <class T>
constexpr bool is_vector = false;
template <class T>
constexpr bool is_vector<std::vector<T>> = true;

// Gives every value in `t` one of its own: 1, 2 and so on, with a fraction that needs every digit, or as
// text. Vectors get two elements. Only one value of bool and of an enumeration is not the first.
template <class T>
void fill(T& t, int& last) {
  if constexpr (std::same_as<T, bool> || std::is_enum_v<T>) {
    t = static_cast<T>(1);
  } else if constexpr (std::integral<T>) {
    t = static_cast<T>(++last);
  } else if constexpr (std::floating_point<T>) {
    t = static_cast<T>(++last + 1.0 / 3);
  } else if constexpr (std::same_as<T, std::string>) {
    t = "text " + std::to_string(++last);
  } else if constexpr (is_optional<T>) {
    fill(t.emplace(), last);
  } else if constexpr (is_vector<T>) {
    for (int i = 0; i < 2; ++i) fill(t.emplace_back(), last);
  } else {
    std::apply([&](auto&... member) { (fill(member, last), ...); }, members(t));
  }
}

// Where two values differ, as the indices of members and elements on the way to them.
template <class T>
void find_differences(const T& a, const T& b, const std::string& place, std::vector<std::string>& found) {
  if constexpr (is_optional<T>) {
    if (a.has_value() != b.has_value()) {
      found.push_back(place + "?");
    } else if (a) {
      find_differences(*a, *b, place, found);
    }
  } else if constexpr (is_vector<T>) {
    if (a.size() != b.size()) {
      found.push_back(place + ".size");
      return;
    }
    for (std::size_t i = 0; i < a.size(); ++i) {
      find_differences(a[i], b[i], place + "[" + std::to_string(i) + "]", found);
    }
  } else if constexpr (!std::is_aggregate_v<T>) {
    if (!(a == b)) found.push_back(place);
  } else {
    const auto other = members(b);
    std::apply(
        [&](const auto&... member) {
          std::size_t i = 0;
          const auto next = [&]<class M>(const M& x, const M& y) {
            find_differences(x, y, place + "." + std::to_string(i++), found);
          };
          std::apply([&](const auto&... twin) { (next(member, twin), ...); }, other);
        },
        members(a));
  }
}

}  // namespace qtrace::test
