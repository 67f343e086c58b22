// Runs the program as a user does, and keeps what it says.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace qtrace::tests {

struct Outcome {
  int exit_code = -1;  // -1: ended by a signal
  std::string out;
  std::string err;
};

// Runs QTRACE_BINARY with these arguments in the folder `working`, without a shell.
Outcome run_qtrace(const std::vector<std::string>& arguments, const std::filesystem::path& working);

// Starts the same and sends it a signal as soon as `ready` says so. Nothing where it had ended before, or was
// not ready within five minutes.
std::optional<Outcome> signal_qtrace_when(int signal, const std::vector<std::string>& arguments,
                                          const std::filesystem::path& working,
                                          const std::function<bool()>& ready);

// The same with SIGKILL. Returns whether it was still running
// then; false, too, where it was not ready within five minutes.
bool kill_qtrace_when(const std::vector<std::string>& arguments, const std::filesystem::path& working,
                      const std::function<bool()>& ready);

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string read_text(const std::filesystem::path& file);
void write_text(const std::filesystem::path& file, const std::string& text);

// Names of everything below a folder, sorted; to show that nothing was written.
std::vector<std::string> tree(const std::filesystem::path& folder);

}  // namespace qtrace::tests
