#include "engine/tracer/qtable.h"

#include "engine/core/check.h"
#include "engine/gpu/structs.h"
namespace qtrace {
namespace {

constexpr std::uint32_t kGroupSize = 64;  // of learn.comp and initial_table.comp

}  // namespace

QTable::QTable(const Scene& scene, const RlSettings& settings, std::size_t columns,
               const gpu::Defines& defines)
    : cells_(scene, settings),
      columns_(columns),
      entries_(cells_.count() * columns),
      values_("Q values (cells x columns)", entries_ * sizeof(float)),
      visits_("Q visits (cells x columns)", entries_ * sizeof(std::uint32_t)),
      sums_("Q targets (cells x columns)", entries_ * sizeof(gpu::TargetSum)),
      starts_("Q distributions (cells x columns)", entries_ * sizeof(std::uint32_t)),
      next_values_("Q next values (cells)", cells_.count() * sizeof(float)),
      initialize_("initial_table.comp", defines),
      learn_("learn.comp", defines) {}

void QTable::bind() const {
  cells_.bind();
  values_.bind_storage(gpu::BINDING_Q_VALUES);
  visits_.bind_storage(gpu::BINDING_Q_VISITS);
  sums_.bind_storage(gpu::BINDING_TARGET_SUMS);
  starts_.bind_storage(gpu::BINDING_COLUMN_STARTS);
  next_values_.bind_storage(gpu::BINDING_NEXT_VALUES);
}

void QTable::learn() {
  bind();
  learn_.dispatch(groups());
}

void QTable::reset() {
  for (gpu::Buffer* buffer : {&visits_, &sums_}) buffer->clear();
  bind();
  initialize_.dispatch(groups());
  learn();
}

std::uint32_t QTable::groups() const { return (cells_.count() + kGroupSize - 1) / kGroupSize; }

std::size_t QTable::bytes() const {
  return cells_.bytes() + values_.bytes() + visits_.bytes() + sums_.bytes() +
         starts_.bytes() + next_values_.bytes();
}

std::vector<float> QTable::values() const { return values_.read_all<float>(); }

std::vector<std::uint32_t> QTable::visits() const { return visits_.read_all<std::uint32_t>(); }

void QTable::set_values(std::span<const float> values) {
  check(values.size() == entries_, "a table of {} values was given for one of {}", values.size(), entries_);
  values_.write(0, values.data(), values.size_bytes());
  learn();
}

}  // namespace qtrace
