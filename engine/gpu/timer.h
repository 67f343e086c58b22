#pragma once

#include <cstdint>

namespace qtrace::gpu {

// Time between two points of the command stream, by a pair of GL_TIMESTAMP queries
// (GL_TIME_ELAPSED reads 0 for compute dispatches on llvmpipe).
class Timer {
 public:
  Timer();
  ~Timer();
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

  void start();
  void stop();
  double milliseconds() const;  // waits for the work between start() and stop()

 private:
  std::uint32_t queries_[2] = {0, 0};
};

}  // namespace qtrace::gpu
