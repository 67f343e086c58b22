// Cells that the frame has gathered targets for, each once: what learn.comp has to look at. Their order is that of the threads;
// what is learned does not depend on it.
#include "shared/structs.glsl"

layout(std430, binding = BINDING_TOUCHED_CELLS) restrict buffer TouchedBuffer {
  TouchedHead touched_head;
  uint touched[];
};
