#include "engine/gpu/driver_probe.h"

#include "engine/gpu/buffer.h"
#include "engine/gpu/program.h"
#include "engine/gpu/shader_source.h"
#include "engine/gpu/structs.h"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace qtrace::gpu {
namespace {

// Without choices of a driver: a probe is what they are made from.
Program plain_program(const std::string& name) { return Program(assemble(name, shader_file(name), {})); }

// By work group, its place in the order in which they began.
std::vector<std::uint32_t> order_of_groups(const Program& program, std::uint32_t groups) {
  const Buffer output("order of work groups", (groups + 1) * sizeof(glm::uvec2));
  output.bind_storage(BINDING_OUTPUT);
  program.dispatch(groups);
  std::vector<std::uint32_t> order;
  for (const glm::uvec2& group : output.read_all<glm::uvec2>()) order.push_back(group.x);
  order.erase(order.begin());  // the counter
  return order;
}

}  // namespace

std::uint32_t probe_loop_limit() {
  constexpr std::uint32_t kTurns = 262144;
  const std::array<std::uint32_t, 3> words{kTurns, 0, 0};
  const Buffer buffer("turns of a loop", std::span<const std::uint32_t>(words));
  buffer.bind_storage(BINDING_OUTPUT);
  plain_program("passes/loop_probe.comp").dispatch(1);
  const std::uint32_t done = buffer.read_all<std::uint32_t>()[1];
  return done == kTurns ? 0 : done;
}

bool splits_by_place(unsigned threads) {
  if (threads < 2) return false;
  constexpr int kTries = 5;
  const Program program = plain_program("passes/order_probe.comp");
  const std::uint32_t part = 2048 / threads;
  for (int i = 0; i < kTries; ++i) {
    const std::vector<std::uint32_t> order = order_of_groups(program, part * threads);
    // The first group of a thread's part begins long before the last one of the part before.
    const auto begins_early = [&](std::uint32_t group) { return order[group] + part / 2 < order[group - 1]; };
    std::uint32_t found = 0;
    for (std::uint32_t group = part; group < order.size(); group += part)
      found += begins_early(group) ? 1U : 0U;
    if (2 * found >= threads - 1) return true;
  }
  return false;
}

}  // namespace qtrace::gpu
