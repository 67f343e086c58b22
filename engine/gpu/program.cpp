#include "engine/gpu/program.h"

#include "engine/core/check.h"
#include "engine/gpu/driver.h"
#include "engine/gpu/structs.h"

#include <epoxy/gl.h>

#include <utility>

namespace qtrace::gpu {
namespace {

// What earlier passes and the host have written, however the next pass reads it.
constexpr GLbitfield kAllWritesSeen = GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                                      GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT;

std::string shader_log(GLuint shader) {
  GLint length = 0;
  glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  glGetShaderInfoLog(shader, length, nullptr, log.data());
  return log.c_str();
}

std::string program_log(GLuint program) {
  GLint length = 0;
  glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  glGetProgramInfoLog(program, length, nullptr, log.data());
  return log.c_str();
}

GLuint compile(const ShaderSource& source) {
  const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
  const char* text = source.text.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  const std::string log = readable_log(shader_log(shader), source);
  glDeleteShader(shader);
  fail("shader {} does not compile:\n{}", source.files.front(), log);
}

}  // namespace

Program::Program(const std::string& name, const Defines& defines)
    : Program(assemble(name, shader_file(name), for_driver(defines))) {}

Program::Program(const ShaderSource& source) {
  const GLuint shader = compile(source);
  id_ = glCreateProgram();
  glAttachShader(id_, shader);
  glLinkProgram(id_);
  glDeleteShader(shader);
  GLint linked = GL_FALSE;
  glGetProgramiv(id_, GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return;
  const std::string log = readable_log(program_log(id_), source);
  glDeleteProgram(id_);
  fail("shader {} does not link:\n{}", source.files.front(), log);
}

Program::~Program() {
  if (id_ != 0) glDeleteProgram(id_);
}

Program::Program(Program&& other) noexcept : id_(std::exchange(other.id_, 0)) {}

Program& Program::operator=(Program&& other) noexcept {
  std::swap(id_, other.id_);
  return *this;
}

void Program::set_frame(std::uint32_t frame) { glProgramUniform1ui(id_, LOCATION_FRAME, frame); }
void Program::set_teaches(bool teaches) { glProgramUniform1ui(id_, LOCATION_TEACHES, teaches ? 1U : 0U); }

void Program::set_weight(float weight) { glProgramUniform1f(id_, LOCATION_WEIGHT, weight); }

void Program::set_point(std::uint32_t sequence, std::span<const glm::uvec4> words) {
  glProgramUniform1ui(id_, LOCATION_SEQUENCE, sequence);
  glProgramUniform4uiv(id_, LOCATION_POINTS, static_cast<GLsizei>(words.size()), &words.front().x);
}

void Program::dispatch(std::uint32_t x, std::uint32_t y) const {
  glUseProgram(id_);
  glMemoryBarrier(kAllWritesSeen);
  glDispatchCompute(x, y, 1);
}

void Program::dispatch_indirect(const Buffer& size) const {
  glUseProgram(id_);
  glMemoryBarrier(kAllWritesSeen | GL_COMMAND_BARRIER_BIT);
  size.bind_dispatch();
  glDispatchComputeIndirect(0);
}

}  // namespace qtrace::gpu
