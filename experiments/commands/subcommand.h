// What every file of this folder adds to the command line.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace qtrace::experiments {

// Does what the command line asks for and returns the exit code.
using Action = std::function<int()>;

// An option with one value that may be given several times, such as --set.
void add_repeated_option(CLI::App& command, const std::string& name, std::vector<std::string>& values,
                         const std::string& help);

}  // namespace qtrace::experiments
