#include "engine/gpu/shader_source.h"

#include "engine/core/check.h"
#include "engine/gpu/embedded_shaders.h"

#include <algorithm>
#include <regex>
#include <sstream>

namespace qtrace::gpu {
namespace {

// Mesa (22.3) forgets the source number of an expression's place, but not its line: so the line holds both.
constexpr std::size_t kLinesPerFile = 100000;

class Assembler {
 public:
  Assembler(const std::string& name, std::string_view text, const Defines& defines) {
    source_.files.push_back(name);
    const std::size_t first_line = text.find('\n');
    check(text.starts_with("#version") && first_line != std::string_view::npos,
          "shader {}: its first line is not a #version", name);
    source_.text = text.substr(0, first_line + 1);
    for (const auto& [key, value] : defines) source_.text += fmt::format("#define {} {}\n", key, value);
    emitted_.push_back(true);
    append(0, text.substr(first_line + 1), 2);
  }

  ShaderSource take() { return std::move(source_); }

 private:
  void append(std::size_t file, std::string_view text, int line) {
    mark(file, line);
    std::istringstream lines{std::string(text)};
    for (std::string current; std::getline(lines, current); ++line) {
      if (current.starts_with("#include")) {
        include(file, current, line);
      } else {
        if (current.starts_with("#if")) ++conditions_;
        if (current.starts_with("#endif")) --conditions_;
        source_.text += current + "\n";
      }
    }
  }

  void mark(std::size_t file, int line) {
    source_.text += fmt::format("#line {} {}\n", file * kLinesPerFile + static_cast<std::size_t>(line), file);
  }

  void include(std::size_t file, const std::string& directive, int line) {
    const std::size_t open = directive.find('"');
    const std::size_t close = directive.rfind('"');
    check(open != std::string::npos && close > open, "{}:{}: an include reads #include \"file\"",
          source_.files[file], line);
    const std::string name = directive.substr(open + 1, close - open - 1);
    const auto known = std::ranges::find(source_.files, name);
    const auto included = static_cast<std::size_t>(known - source_.files.begin());
    if (known == source_.files.end()) {
      source_.files.push_back(name);
      emitted_.push_back(false);
    }
    if (!emitted_[included]) emit(included);
    mark(file, line + 1);
  }

  // Where a condition stands around an include, its text may be left out there and wanted later: it is put in
  // again until it stands under no condition, and a guard takes it once.
  void emit(std::size_t file) {
    check(std::ranges::find(open_, file) == open_.end(), "shader {} includes itself", source_.files[file]);
    if (conditions_ == 0) emitted_[file] = true;
    source_.text += fmt::format("#ifndef INCLUDED_{0}\n#define INCLUDED_{0}\n", file);
    open_.push_back(file);
    append(file, shader_file(source_.files[file]), 1);
    open_.pop_back();
    source_.text += "#endif\n";
  }

  ShaderSource source_;
  std::vector<bool> emitted_;      // of source_.files: under no condition
  std::vector<std::size_t> open_;  // files that are being put in
  int conditions_ = 0;             // around the current line
};

}  // namespace

std::string_view shader_file(std::string_view name) {
  for (const EmbeddedShader& shader : embedded_shaders()) {
    if (shader.name == name) return shader.text;
  }
  fail("there is no shader file {}", name);
}

ShaderSource assemble(const std::string& name, std::string_view text, const Defines& defines) {
  return Assembler(name, text, defines).take();
}

std::string readable_log(const std::string& log, const ShaderSource& source) {
  static const std::regex place(R"(^(\d+)(?::(\d+)\(\d+\)|\((\d+)\) ?))");
  std::istringstream lines(log);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_search(line, match, place)) {
      const std::size_t number = std::stoul(match[2].matched ? match[2].str() : match[3].str());
      const std::size_t file = number / kLinesPerFile;
      if (file < source.files.size()) {
        line = fmt::format("{}:{}{}", source.files[file], number % kLinesPerFile, match.suffix().str());
      }
    }
    result += line + "\n";
  }
  return result;
}

}  // namespace qtrace::gpu
