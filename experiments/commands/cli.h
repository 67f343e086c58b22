// The command line.
#pragma once

namespace qtrace::experiments {

// Exit code: 0 done, 1 bad input or failed runs, 2 wrong usage. Errors go to standard error as one sentence.
int run_command_line(int argc, const char* const* argv);

}  // namespace qtrace::experiments
