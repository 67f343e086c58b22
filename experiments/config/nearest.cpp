#include "experiments/config/nearest.h"

#include <algorithm>
#include <numeric>

namespace qtrace::experiments {
namespace {

std::string_view last_part(std::string_view key) {
  const std::size_t dot = key.rfind('.');
  return dot == std::string_view::npos ? key : key.substr(dot + 1);
}

// More than `limit` at once where the lengths say so; else counts the steps that it takes.
std::size_t bounded_distance(std::string_view a, std::string_view b, std::size_t limit, std::size_t& steps) {
  if (std::max(a.size(), b.size()) - std::min(a.size(), b.size()) > limit) return limit + 1;
  steps += a.size() * b.size();
  return edit_distance(a, b);
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);  // distances from a's prefix to each prefix of b
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  constexpr std::size_t kMaxSteps = 2'000'000;  // milliseconds; a hint is worth no more
  const std::size_t limit = std::max<std::size_t>(2, word.size() / 3);
  std::size_t steps = 0;
  std::size_t best_distance = limit + 1;
  std::string best;
  for (const std::string& candidate : candidates) {
    const std::size_t distance =
        std::min(bounded_distance(word, candidate, limit, steps),
                 bounded_distance(last_part(word), last_part(candidate), limit, steps));
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
    if (steps > kMaxSteps) break;
  }
  return best;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string near = nearest(word, candidates);
  return near.empty() ? std::string() : "; did you mean '" + near + "'?";
}

}  // namespace qtrace::experiments
