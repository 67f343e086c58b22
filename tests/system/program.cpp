#include "tests/system/program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

namespace qtrace::tests {
namespace {

namespace fs = std::filesystem;

// A file that collects one output stream; gone with this object.
class Capture {
 public:
  Capture() {
    std::string name = (fs::temp_directory_path() / "qtrace_output_XXXXXX").string();
    const int descriptor = ::mkstemp(name.data());
    if (descriptor < 0) throw std::runtime_error("no temporary file");
    ::close(descriptor);
    file_ = name;
  }
  ~Capture() { fs::remove(file_); }
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;
  const fs::path& file() const { return file_; }

 private:
  fs::path file_;
};

pid_t start_qtrace(const std::vector<std::string>& arguments, const fs::path& working, const Capture& out,
                   const Capture& err) {
  // "cd" through sh, because posix_spawn's own change of folder is not in every C library; the arguments
  // travel beside the script, so that nothing needs quoting.
  std::vector<std::string> words{"sh", "-c", "cd \"$0\" && exec \"$@\"", working.string(), QTRACE_BINARY};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.file().c_str(), O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.file().c_str(), O_WRONLY, 0);
  pid_t child = 0;
  const int spawned = ::posix_spawn(&child, "/bin/sh", &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (spawned != 0) throw std::runtime_error("cannot start /bin/sh");
  return child;
}

}  // namespace

Outcome run_qtrace(const std::vector<std::string>& arguments, const fs::path& working) {
  const Capture out, err;
  const pid_t child = start_qtrace(arguments, working, out, err);
  int status = 0;
  ::waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(out.file()), read_text(err.file())};
}

std::optional<Outcome> signal_qtrace_when(int signal, const std::vector<std::string>& arguments,
                                          const fs::path& working, const std::function<bool()>& ready) {
  const Capture out, err;
  const pid_t child = start_qtrace(arguments, working, out, err);
  int status = 0;
  const auto latest = std::chrono::steady_clock::now() + std::chrono::minutes(5);
  bool is_ready = false;
  while (!is_ready && std::chrono::steady_clock::now() < latest) {
    if (::waitpid(child, &status, WNOHANG) == child) return std::nullopt;
    is_ready = ready();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ::kill(child, is_ready ? signal : SIGKILL);
  ::waitpid(child, &status, 0);
  if (!is_ready) return std::nullopt;
  return Outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(out.file()), read_text(err.file())};
}

bool kill_qtrace_when(const std::vector<std::string>& arguments, const fs::path& working,
                      const std::function<bool()>& ready) {
  const auto outcome = signal_qtrace_when(SIGKILL, arguments, working, ready);
  return outcome && outcome->exit_code == -1;
}

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void write_text(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

std::vector<std::string> tree(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    // By the letters alone: a program at work may have taken the file away again.
    names.push_back(entry.path().lexically_relative(folder).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace qtrace::tests
