// Other programs: found on the PATH, run without a shell, and words quoted for one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace qtrace::experiments {

// Whether a program of this name is on the PATH.
bool on_path(std::string_view program);

struct CommandResult {
  int exit_code = -1;  // -1: ended by a signal
  std::string out;
  std::string err;
};

// Runs a program of the PATH to its end, without input. Throws Error where it cannot be started.
CommandResult run_program(const std::vector<std::string>& words);

// The text as one word of a POSIX shell, whatever it holds.
std::string shell_word(std::string_view text);

}  // namespace qtrace::experiments
