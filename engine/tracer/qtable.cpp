#include "engine/tracer/qtable.h"

#include "engine/core/check.h"
#include "engine/gpu/structs.h"

#include <random>

namespace qtrace {
namespace {

constexpr std::uint32_t kGroupSize = 64;  // of learn.comp

// Uniform in [0, 1). The generator's sequence is fixed by the C++ standard, its distributions are not.
std::vector<float> random_values(std::size_t count, std::uint32_t seed) {
  std::mt19937 generator(seed);
  std::vector<float> values(count);
  for (float& value : values) value = static_cast<float>(generator() >> 8) * (1.0F / 16777216.0F);
  return values;
}

}  // namespace

QTable::QTable(const Scene& scene, const RlSettings& settings, const gpu::Defines& defines,
               std::uint32_t seed)
    : cells_(scene, settings),
      entries_(std::size_t{cells_.count()} * static_cast<std::size_t>(settings.bins_theta * settings.bins_phi)),
      initial_table_(settings.initial_table),
      seed_(seed),
      values_("Q values (sites x bins)", entries_ * sizeof(float)),
      visits_("Q visits (sites x bins)", entries_ * sizeof(std::uint32_t)),
      sums_("Q targets (sites x bins)", entries_ * sizeof(gpu::TargetSum)),
      bin_starts_("Q distributions (sites x bins)", entries_ * sizeof(std::uint32_t)),
      next_values_("Q next values (sites)", cells_.count() * sizeof(float)),
      learn_("learn.comp", defines) {}

std::size_t QTable::entries(const Scene& scene, const RlSettings& settings) {
  return CellBuffers::count(scene, settings) * static_cast<std::size_t>(settings.bins_theta * settings.bins_phi);
}

void QTable::bind() const {
  cells_.bind();
  values_.bind_storage(gpu::BINDING_Q_VALUES);
  visits_.bind_storage(gpu::BINDING_Q_VISITS);
  sums_.bind_storage(gpu::BINDING_TARGET_SUMS);
  bin_starts_.bind_storage(gpu::BINDING_BIN_STARTS);
  next_values_.bind_storage(gpu::BINDING_NEXT_VALUES);
}

void QTable::learn() {
  bind();
  learn_.dispatch((cells_.count() + kGroupSize - 1) / kGroupSize);
}

void QTable::reset() {
  for (gpu::Buffer* buffer : {&values_, &visits_, &sums_}) buffer->clear();
  if (initial_table_ == InitialTable::random) {
    const std::vector<float> values = random_values(entries_, seed_);
    values_.write(0, values.data(), values.size() * sizeof(float));
  }
  learn();
}

std::size_t QTable::bytes() const {
  return cells_.bytes() + values_.bytes() + visits_.bytes() + sums_.bytes() +
         bin_starts_.bytes() + next_values_.bytes();
}

std::vector<float> QTable::values() const { return values_.read_all<float>(); }

std::vector<std::uint32_t> QTable::visits() const { return visits_.read_all<std::uint32_t>(); }

void QTable::set_values(std::span<const float> values) {
  check(values.size() == entries_, "a table of {} values was given for one of {}", values.size(), entries_);
  values_.write(0, values.data(), values.size_bytes());
  learn();
}

}  // namespace qtrace
