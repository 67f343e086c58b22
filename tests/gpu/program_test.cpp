// Shaders that do not compile say where.
#include "engine/gpu/program.h"
#include "engine/core/check.h"
#include "tests/support/device.h"

#include <gtest/gtest.h>

namespace qtrace::gpu {
namespace {

std::string message_of(const std::string& text) {
  try {
    const Program program(assemble("broken.comp", text, {{"SOME_DEFINE", "1"}}));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Program, ErrorNamesFileAndLine) {
  test::device();
  const std::string head = "#version 450 core\n#include \"sampling/random.glsl\"\nlayout(local_size_x = 1) in;\n";
  const std::string message = message_of(head + "void main() {\n  undeclared = 1;\n}\n");
  EXPECT_NE(message.find("broken.comp:5"), std::string::npos) << message;
  EXPECT_NE(message.find("undeclared"), std::string::npos) << message;
}

TEST(Program, ErrorInsideAnIncludeNamesTheInclude) {
  test::device();
  // bins.glsl needs the numbers of bins as defines.
  const std::string message =
      message_of("#version 450 core\n#include \"learning/bins.glsl\"\nlayout(local_size_x = 1) in;\nvoid main() {}\n");
  EXPECT_NE(message.find("bins.glsl:7"), std::string::npos) << message;
}

TEST(Program, UnknownIncludeIsNamed) {
  EXPECT_NE(message_of("#version 450 core\n#include \"absent.glsl\"\n").find("absent.glsl"),
            std::string::npos);
}

TEST(Program, LogsOfBothDriversAreRead) {
  const ShaderSource source{"", {"passes/trace.comp", "material/bsdf.glsl"}};
  EXPECT_EQ(readable_log("0:100012(5): error: a", source), "material/bsdf.glsl:12: error: a\n");
  EXPECT_EQ(readable_log("0(7) : error C1: b", source), "passes/trace.comp:7: error C1: b\n");
}

}  // namespace
}  // namespace qtrace::gpu
