#include "engine/tracer/stratified_points.h"

#include "engine/tracer/sobol.h"

#include <array>

namespace qtrace {
namespace {

// A word of a block that is coordinate `dimension` of its group's point. The first two dimensions are the
// best together.
struct Word {
  gpu::uint block;
  int component;
  int dimension;
};
using Group = std::vector<Word>;

const Group kCamera{{gpu::BLOCK_CAMERA, 0, 0}, {gpu::BLOCK_CAMERA, 1, 1}};
// Of an event: point on the light, the light, its triangle; the direction with the table's bin or the BSDF's
// lobe and the side of the mixture; the direction with which two_ray looks for the light, with its lobe;
// Russian roulette.
const std::array<Group, 4> kEvent{
    Group{{gpu::BLOCK_LIGHT, 1, 0},
          {gpu::BLOCK_LIGHT, 2, 1},
          {gpu::BLOCK_LIGHT, 0, 2},
          {gpu::BLOCK_MORE, 0, 3}},
    Group{{gpu::BLOCK_DIRECTION, 1, 0},
          {gpu::BLOCK_DIRECTION, 2, 1},
          {gpu::BLOCK_DIRECTION, 3, 2},
          {gpu::BLOCK_DIRECTION, 0, 3}},
    Group{{gpu::BLOCK_TWO_RAY, 1, 0}, {gpu::BLOCK_TWO_RAY, 2, 1}, {gpu::BLOCK_TWO_RAY, 3, 2}},
    Group{
        {gpu::BLOCK_LIGHT, 3, 0}, {gpu::BLOCK_MORE, 1, 1}, {gpu::BLOCK_MORE, 2, 2}, {gpu::BLOCK_MORE, 3, 3}}};

}  // namespace

std::vector<gpu::uvec4> stratified_points(std::uint32_t seed, std::uint32_t sequence, std::uint32_t index,
                                          int events) {
  std::vector<gpu::uvec4> points(1 + gpu::BLOCKS_PER_EVENT * static_cast<std::size_t>(events));
  std::uint32_t group_number = 0;
  const auto place = [&](const Group& group, gpu::uint first_block) {
    const std::uint32_t of_group = shuffled(index, mixed(seed ^ mixed(sequence ^ mixed(++group_number))));
    for (const Word& word : group)
      points[first_block + word.block][word.component] = reversed_bits(sobol(of_group, word.dimension));
  };
  place(kCamera, 0);
  for (int event = 0; event < events; ++event) {
    for (const Group& group : kEvent) place(group, gpu::BLOCKS_PER_EVENT * static_cast<gpu::uint>(event));
  }
  return points;
}

}  // namespace qtrace
