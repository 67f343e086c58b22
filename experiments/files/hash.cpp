#include "experiments/files/hash.h"

#include <fmt/format.h>

namespace qtrace::experiments {
namespace {

std::string hex(const XXH128_hash_t& hash) { return fmt::format("{:016x}{:016x}", hash.high64, hash.low64); }

}  // namespace

std::string hash_text(std::string_view text) { return hex(XXH3_128bits(text.data(), text.size())); }

Hasher::Hasher() : state_(XXH3_createState(), &XXH3_freeState) { XXH3_128bits_reset(state_.get()); }

std::string Hasher::digest() const { return hex(XXH3_128bits_digest(state_.get())); }

}  // namespace qtrace::experiments
