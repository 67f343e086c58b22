#include "engine/gpu/fetch.h"

#include "engine/gpu/driver.h"
#include "engine/gpu/structs.h"

#include <epoxy/gl.h>

namespace qtrace::gpu {

Fetch best_fetch() { return is_llvmpipe() ? Fetch::image : Fetch::texture; }

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

}  // namespace qtrace::gpu
