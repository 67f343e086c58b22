// Shader text with its includes put in, and the way back from the driver's line numbers.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace qtrace::gpu {

// Compile-time choices: name and value; the order of the map keeps a program's text, and so its bits, stable.
using Defines = std::map<std::string, std::string>;

struct ShaderSource {
  std::string text;
  std::vector<std::string> files;  // names by source number
};

// The text of shaders/<name>, as built into the program. Throws Error where there is none.
std::string_view shader_file(std::string_view name);

// `text`, whose first line is its #version, with `defines` after that line and every #include "file" replaced
// by shaders/file, once each whatever #if stands around it. `name` is what errors call it.
ShaderSource assemble(const std::string& name, std::string_view text, const Defines& defines);

// A driver's log with its places replaced: "3:300012(5): error" (Mesa) and "3(300012) : error" (NVIDIA)
// become "bsdf.glsl:12: error".
std::string readable_log(const std::string& log, const ShaderSource& source);

}  // namespace qtrace::gpu
