// Loops that a driver may end early: how they are written, and why, is in shaders/README.md.

// Set where a loop ended before its own condition did. Reported, never ignored.
bool loop_was_cut = false;
