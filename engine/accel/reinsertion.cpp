#include "engine/accel/reinsertion.h"

#include "engine/accel/bvh_tree.h"

#include <algorithm>
#include <future>
#include <thread>

namespace qtrace {
namespace {

// Measured on llvmpipe: more rounds or nodes gain nothing that shows, and a batch this large keeps 5 million
// triangles within seconds.
constexpr int kRounds = 8;
constexpr double kTried = 0.2;  // of all nodes in a round
constexpr std::size_t kLeastTried = 1000;
constexpr std::size_t kMostTried = 100'000;

// From the best.
std::vector<SubtreeMove> find_moves(const BvhTree& tree, const std::vector<std::uint32_t>& nodes) {
  std::vector<SubtreeMove> moves(nodes.size());
  const std::size_t threads = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::future<void>> tasks;
  for (std::size_t task = 0; task < threads; ++task) {
    tasks.push_back(std::async(std::launch::async, [&, task] {
      for (std::size_t i = task; i < nodes.size(); i += threads) moves[i] = tree.best_move(nodes[i]);
    }));
  }
  for (std::future<void>& task : tasks) task.get();
  std::erase_if(moves, [](const SubtreeMove& move) { return move.beside == kNoNode; });
  std::ranges::sort(moves, [](const SubtreeMove& a, const SubtreeMove& b) {
    return a.gain != b.gain ? a.gain > b.gain : a.node < b.node;
  });
  return moves;
}

}  // namespace

void reinsert_subtrees(Bvh& bvh) {
  BvhTree tree(bvh);
  const auto tried = std::clamp(static_cast<std::size_t>(kTried * static_cast<double>(tree.size())),
                                kLeastTried, kMostTried);
  for (int round = 0; round < kRounds; ++round) {
    tree.forget_moves();
    const std::vector<SubtreeMove> moves = find_moves(tree, tree.largest(tried));
    for (const SubtreeMove& move : moves) {
      if (tree.can_apply(move)) tree.apply(move);
    }
    // The last one that is not too deep stays.
    if (!tree.store(bvh) || moves.empty()) return;
  }
}

}  // namespace qtrace
