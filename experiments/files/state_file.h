// The state of a tracer on disk, so that another process can go on: a line with the hash of the rest, then
// CBOR (RFC 8949) with "about", "frames" and "buffers", an object of byte strings.
#pragma once

#include "engine/tracer/tracer_state.h"
#include "experiments/files/json.h"

#include <filesystem>
#include <string>

namespace qtrace::experiments {

struct StoredState {
  Json about;  // whatever the writer needs besides
  TracerState state;
};

std::string state_text(const StoredState& stored);  // the file's content

// Replaces the file whole or not at all. Throws Error that names it.
void write_state(const std::filesystem::path& file, const StoredState& stored);

// Throws Error that names the file: missing, or not whole.
StoredState read_state(const std::filesystem::path& file);

}  // namespace qtrace::experiments
