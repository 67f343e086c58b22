#include "engine/gpu/fetch.h"

#include "engine/gpu/structs.h"

#include <epoxy/gl.h>

namespace qtrace::gpu {

static_assert(FETCHED_UNITS <= 96, "the units that every device of OpenGL 4.5 has");

bool offers(Fetch fetch) {
  if (fetch != Fetch::image) return true;
  GLint units = 0;
  glGetIntegerv(GL_MAX_IMAGE_UNITS, &units);
  return units >= FETCHED_UNITS;
}

std::string fetch_name(Fetch fetch) {
  switch (fetch) {
    case Fetch::texture:
      return "texture";
    case Fetch::image:
      return "image";
    case Fetch::storage:
      return "storage";
  }
  return "";
}

std::optional<Fetch> fetch_named(std::string_view name) {
  for (const Fetch fetch : {Fetch::texture, Fetch::image, Fetch::storage}) {
    if (fetch_name(fetch) == name) return fetch;
  }
  return std::nullopt;
}

}  // namespace qtrace::gpu
