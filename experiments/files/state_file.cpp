#include "experiments/files/state_file.h"

#include "engine/core/check.h"
#include "experiments/files/atomic_file.h"
#include "experiments/files/hash.h"

#include <algorithm>
#include <cstring>

namespace qtrace::experiments {
namespace {

constexpr std::size_t kHashDigits = 32;

Json to_json(const StoredState& stored) {
  Json buffers = Json::object();
  for (const SavedBuffer& buffer : stored.state.buffers) {
    Json::binary_t bytes;
    bytes.resize(buffer.bytes.size());
    std::memcpy(bytes.data(), buffer.bytes.data(), bytes.size());
    buffers[buffer.name] = Json::binary(std::move(bytes));
  }
  return {{"about", stored.about}, {"frames", stored.state.frames}, {"buffers", std::move(buffers)}};
}

StoredState from_json(const Json& json) {
  StoredState stored{json.at("about"), {json.at("frames").get<std::uint32_t>(), {}}};
  for (const auto& [name, value] : json.at("buffers").items()) {
    const Json::binary_t& bytes = value.get_binary();
    SavedBuffer& buffer = stored.state.buffers.emplace_back(SavedBuffer{name, {}});
    buffer.bytes.resize(bytes.size());
    std::memcpy(buffer.bytes.data(), bytes.data(), bytes.size());
  }
  return stored;
}

}  // namespace

std::string state_text(const StoredState& stored) {
  std::string content;
  Json::to_cbor(to_json(stored), content);
  return hash_text(content) + '\n' + content;
}

void write_state(const std::filesystem::path& file, const StoredState& stored) {
  write_file(file, state_text(stored));
}

StoredState read_state(const std::filesystem::path& file) {
  const std::string content = read_file(file);
  const std::size_t head = std::min(kHashDigits + 1, content.size());
  check(content.substr(0, head) == hash_text(std::string_view(content).substr(head)) + '\n',
        "{}: is no saved state, or damaged: its content does not have the hash in its first line",
        file.string());
  try {
    return from_json(Json::from_cbor(content.begin() + static_cast<std::ptrdiff_t>(head), content.end()));
  } catch (const Json::exception& error) {
    fail("{}: is no saved state: {}", file.string(), error.what());
  }
}

}  // namespace qtrace::experiments
