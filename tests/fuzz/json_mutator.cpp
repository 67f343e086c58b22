#include "tests/fuzz/json_mutator.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <random>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace qtrace::fuzz {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxSize = std::size_t{1} << 20U;

// Where readers of numbers, lists and texts go wrong.
const Json& odd_values() {
  static const Json values =
      Json::parse(R"([null, true, false, 0, 1, 2, -1, 0.5, -0.0, 7, 16, 64, 255, 256, 65535,
    65536, 100000, 1000000, 2147483647, 2147483648, 4294967295, 4294967296, 9007199254740993,
    9223372036854775807, 18446744073709551615, -9223372036854775808, 1e-320, 1e-40, 1e-7, 3.4e38, 3.5e38, 1e39, 1e308,
    -1e308, "", "a", ".", "..", "/", "%2e%2e/", "\u0000", "\n", "\u00e9", "\ud83d\ude00", [], {}, [[]], [0, 0, 0], [1, 1, 1, 1]])");
  return values;
}

class Mutator {
 public:
  Mutator(Json& document, unsigned seed) : document_(document), random_(seed) {}

  void change() {
    std::vector<Json*> nodes;
    collect(document_, nodes);
    Json& node = *nodes[below(nodes.size())];
    switch (below(6)) {
      case 0:
        node = odd_values()[below(odd_values().size())];
        break;
      case 1:
        node = Json(*nodes[below(nodes.size())]);
        break;
      case 2:
        return remove(node);
      case 3:
        return repeat(node);
      case 4:
        return rename(node, *nodes[below(nodes.size())]);
      default:
        return nudge(node);
    }
  }

 private:
  std::size_t below(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_);
  }

  static void collect(Json& node, std::vector<Json*>& nodes) {
    nodes.push_back(&node);
    if (!node.is_structured()) return;
    for (Json& child : node) collect(child, nodes);
  }

  void remove(Json& node) {
    if (node.is_structured() && !node.empty()) node.erase(std::next(node.begin(), offset(node)));
  }

  // One element of a list or one member of an object, up to 256 times.
  void repeat(Json& node) {
    if (!node.is_structured() || node.empty()) return;
    const auto chosen = std::next(node.begin(), offset(node));
    const Json value = *chosen;
    const std::string key = node.is_object() ? chosen.key() : "";
    const std::size_t count = std::size_t{1} << below(9);
    for (std::size_t i = 0; i < count && value.size() * count < kMaxSize; ++i) {
      if (node.is_array()) {
        node.push_back(value);
      } else {
        node[key + std::to_string(i)] = value;
      }
    }
  }

  // Gives a member's value the key of a member elsewhere.
  void rename(Json& node, const Json& other) {
    if (!node.is_object() || !other.is_object() || node.empty() || other.empty()) return;
    const std::string key = std::next(other.begin(), offset(other)).key();
    node[key] = Json(*std::next(node.begin(), offset(node)));
  }

  void nudge(Json& node) {
    const std::array factors{0.5, 2.0, -1.0, 1.0001, 1e3, 1e-3};
    if (node.is_number_integer()) {
      const auto unsigned_value = static_cast<std::uint64_t>(node.get<std::int64_t>());  // may wrap
      node = static_cast<std::int64_t>(unsigned_value / (1 + below(2)) + below(5) - 2);
    } else if (node.is_number()) {
      node = node.get<double>() * factors[below(factors.size())];
    } else if (node.is_string()) {
      node = node.get<std::string>().substr(0, below(64)) + odd_text();
    }
  }

  std::string odd_text() {
    const std::array<std::string, 6> texts{"", ".", " ", "0", "\u00e9", std::string(below(300), 'x')};
    return texts[below(texts.size())];
  }

  std::ptrdiff_t offset(const Json& container) {
    return static_cast<std::ptrdiff_t>(below(container.size()));
  }

  Json& document_;
  std::mt19937 random_;
};

}  // namespace

std::string mutate_json(std::string_view text, unsigned seed) {
  Json document = Json::parse(text, nullptr, false, true);
  if (document.is_discarded()) return "";
  Mutator mutator(document, seed);
  for (unsigned i = 0; i <= seed % 4; ++i) mutator.change();
  return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string mutate_bytes(std::string_view bytes, std::size_t max_size) {
  std::vector<std::uint8_t> buffer(std::max(max_size, bytes.size()));
  std::copy(bytes.begin(), bytes.end(), buffer.begin());
  const std::size_t size = LLVMFuzzerMutate(buffer.data(), bytes.size(), buffer.size());
  return std::string(as_text(buffer.data(), size));
}

std::size_t store(std::string_view bytes, std::uint8_t* data, std::size_t max_size) {
  if (bytes.size() > max_size) return 0;
  std::memcpy(data, bytes.data(), bytes.size());
  return bytes.size();
}

}  // namespace qtrace::fuzz
