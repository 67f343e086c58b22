#include "engine/gpu/timer.h"

#include <epoxy/gl.h>

namespace qtrace::gpu {

Timer::Timer() { glCreateQueries(GL_TIMESTAMP, 2, queries_); }

Timer::~Timer() { glDeleteQueries(2, queries_); }

void Timer::start() { glQueryCounter(queries_[0], GL_TIMESTAMP); }

void Timer::stop() { glQueryCounter(queries_[1], GL_TIMESTAMP); }

double Timer::milliseconds() const {
  GLuint64 start = 0;
  GLuint64 stop = 0;
  glGetQueryObjectui64v(queries_[0], GL_QUERY_RESULT, &start);
  glGetQueryObjectui64v(queries_[1], GL_QUERY_RESULT, &stop);
  constexpr double kMillisecondsPerNanosecond = 1e-6;
  return static_cast<double>(stop - start) * kMillisecondsPerNanosecond;
}

}  // namespace qtrace::gpu
