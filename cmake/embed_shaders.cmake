# Writes OUTPUT, a C++ file that holds the text of every file in FILES (a list, separated by ","), by its path below ROOT.
# Run by cmake -P whenever a shader changes.
string(REPLACE "," ";" FILES "${FILES}")
set(text "#include \"engine/gpu/embedded_shaders.h\"\n\n#include <array>\n\nnamespace qtrace::gpu {\n\n")
list(LENGTH FILES count)
string(APPEND text "std::span<const EmbeddedShader> embedded_shaders() {\n"
                   "  static constexpr std::array<EmbeddedShader, ${count}> shaders{{\n")
foreach(file IN LISTS FILES)
  file(RELATIVE_PATH name ${ROOT} ${file})
  file(READ ${file} content)
  string(APPEND text "      {\"${name}\", R\"GLSL(${content})GLSL\"},\n")
endforeach()
string(APPEND text "  }};\n  return shaders;\n}\n\n}  // namespace qtrace::gpu\n")
file(WRITE ${OUTPUT} "${text}")
