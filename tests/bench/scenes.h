// Scenes by name, and a generated one of any size.
#pragma once

#include "engine/scene/scene.h"

#include <cstdint>
#include <string>

namespace qtrace::bench {

// A closed room, 10 wide, with a light under its ceiling and dented balls on a grid, of about so many
// triangles; the same ones at every call.
Scene room(std::uint32_t triangles);

// room:TRIANGLES, else a glTF file. Throw Error that says what is wrong with it, the first without loading
// it.
void check_scene(const std::string& name);
Scene bench_scene(const std::string& name);
// In tables: a file's scene by its own name.
std::string shown_name(const std::string& name, const Scene& scene);

}  // namespace qtrace::bench
