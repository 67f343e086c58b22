// Cells that the frame taught something, each once: what learn.comp has to look at. Their order is that of the threads;
// what is learned does not depend on it.
layout(std430, binding = BINDING_TOUCHED_CELLS) restrict buffer TouchedBuffer {
  TouchedHead touched_head;
  uint touched[];  // the list, then the marks of every cell: a bit for each of its columns, modulo 32
};

uint mark_of(uint cell) {
  return parameters.path.w + cell;
}

bool is_marked(uint marks, uint column) {
  return ((marks >> (column & 31u)) & 1u) != 0u;
}

void touch(uint cell, uint column) {
  if (is_marked(touched[mark_of(cell)], column)) return;
  if (atomicOr(touched[mark_of(cell)], 1u << (column & 31u)) == 0u) {
    uint place = atomicAdd(touched_head.count, 1u);
    touched[place] = cell;
    if (place % LEARN_GROUP == 0u) atomicAdd(touched_head.groups_x, 1u);
  }
}
