// A small shader of a test's own on top of shaders/, with one output element per invocation.
#pragma once

#include "engine/gpu/buffer.h"
#include "engine/gpu/driver.h"
#include "engine/gpu/program.h"
#include "engine/gpu/structs.h"
#include "tests/support/device.h"

#include <string>
#include <vector>

namespace qtrace::test {

// `includes`: files of shaders/. `body`: statements that set `result` (uvec4 or vec4, `type`) from `index`.
// Scene, parameters and table are those that are bound.
template <class T>
std::vector<T> probe(const std::string& type, const std::vector<std::string>& includes,
                     const std::string& functions, const std::string& body, std::uint32_t count,
                     const gpu::Defines& defines = {}) {
  std::string text = "#version 450 core\n";
  for (const std::string& file : includes) text += "#include \"" + file + "\"\n";
  text += "layout(local_size_x = 64) in;\n";
  text += "layout(std430, binding = BINDING_OUTPUT) buffer ProbeBuffer { " + type + " results[]; };\n" +
          functions;
  text +=
      "\nvoid main() {\n  uint index = gl_GlobalInvocationID.x;\n  if (index >= " + std::to_string(count) +
      "u) return;\n  " + type + " result;\n" + body + "\n  results[index] = result;\n}\n";
  const gpu::Program program(gpu::assemble("probe", text, gpu::for_driver(defines)));
  gpu::Buffer output("probe results", count * sizeof(T));
  output.bind_storage(gpu::BINDING_OUTPUT);
  program.dispatch((count + 63) / 64);
  device().finish();
  return output.read_all<T>();
}

}  // namespace qtrace::test
