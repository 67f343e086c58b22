// What a driver does that OpenGL does not tell, found by looking at what comes out of small shaders.
#pragma once

#include <cstdint>

namespace qtrace::gpu {

// After how many turns the current context's driver ends the loops of an invocation, all of them together; 0
// where a quarter of a million were done as asked.
std::uint32_t probe_loop_limit();

// Whether the driver gives each of so many threads one contiguous run of a dispatch's work groups, as seen in
// the order in which they begin. A busy machine may hide it: a false answer costs time, a true one is
// certain.
bool splits_by_place(unsigned threads);

}  // namespace qtrace::gpu
