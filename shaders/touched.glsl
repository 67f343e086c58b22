// Cells that the frame taught something, each once: what learn.comp has to look at. Their order is that of the threads;
// what is learned does not depend on it.
layout(std430, binding = BINDING_TOUCHED_CELLS) restrict buffer TouchedBuffer {
  TouchedHead touched_head;
  uint touched[];  // the list, then a mark for every cell
};

uint mark_of(uint cell) {
  return parameters.path.w + cell;
}

void touch(uint cell) {
  if (touched[mark_of(cell)] == 0u && atomicExchange(touched[mark_of(cell)], 1u) == 0u) {
    uint place = atomicAdd(touched_head.count, 1u);
    touched[place] = cell;
    if (place % LEARN_GROUP == 0u) atomicAdd(touched_head.groups_x, 1u);
  }
}
