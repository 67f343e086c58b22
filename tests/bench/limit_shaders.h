// What a device can do at most, one thing at a time.
#pragma once

#include "engine/gpu/buffer.h"
#include "engine/gpu/program.h"

#include <cstdint>

namespace qtrace::bench {

// Fused multiply-adds in registers.
class ArithmeticLimit {
 public:
  ArithmeticLimit();
  void run() const;            // does not wait
  static double operations();  // of a run

 private:
  gpu::Buffer output_;
  gpu::Program program_;
};

// Nodes of a hierarchy, two elements next to each other, at random places among the first, which stay in the
// nearest cache. The scene must be bound.
class FetchLimit {
 public:
  explicit FetchLimit(std::size_t nodes);  // that there are
  void run() const;
  static double elements();  // fetched by a run

 private:
  gpu::Buffer output_;
  gpu::Program program_;
};

// One buffer into another.
class MemoryLimit {
 public:
  MemoryLimit();
  void run() const;
  static double bytes();  // read and written by a run

 private:
  gpu::Buffer from_;
  gpu::Buffer to_;
  gpu::Program program_;
};

}  // namespace qtrace::bench
