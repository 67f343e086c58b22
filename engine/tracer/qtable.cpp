#include "engine/tracer/qtable.h"

#include "engine/core/check.h"
#include "engine/gpu/structs.h"

#include <numeric>

namespace qtrace {
namespace {

std::uint32_t groups_of(std::uint32_t cells) { return (cells + gpu::LEARN_GROUP - 1) / gpu::LEARN_GROUP; }

// The names of these buffers stand in saved states.
constexpr const char* kSums = "Q targets (cells x columns)";

// With the marks of the cells.
std::size_t sum_bytes(std::size_t cells, std::size_t actions) {
  return cells * (actions * sizeof(gpu::TargetSum) + sizeof(std::uint32_t));
}

std::vector<gpu::CellPlace> pack_places(const std::vector<CellState>& states) {
  std::vector<gpu::CellPlace> places;
  places.reserve(states.size());
  for (const CellState& s : states) places.push_back({glm::vec4(s.position, 0), glm::vec4(s.normal, 0)});
  return places;
}

}  // namespace

QTable::QTable(const Scene& scene, const RlSettings& settings, std::size_t actions,
               const gpu::Defines& defines, gpu::ProgramCache& programs)
    : cells_(scene, settings),
      actions_(actions),
      entries_(cells_.count() * actions),
      values_("Q values (cells x columns)", entries_ * sizeof(float), gpu::also_fetched(gpu::Texels::float1)),
      visits_("Q visits (cells x columns)", entries_ * sizeof(std::uint32_t)),
      sums_(kSums, sum_bytes(cells_.count(), actions)),
      starts_("Q distributions (cells x columns)", entries_ * sizeof(std::uint32_t),
              gpu::also_fetched(gpu::Texels::uint1)),
      next_values_("Q next values (cells)", cells_.count() * sizeof(float),
                   gpu::also_fetched(gpu::Texels::float1)),
      bsdf_shares_("shares of the BSDF (cells)", cells_.count() * sizeof(float),
                   gpu::also_fetched(gpu::Texels::float1)),
      touched_("touched cells", sizeof(gpu::TouchedHead) + cells_.count() * sizeof(std::uint32_t)),
      places_("places of cells", pack_places(cells_.states())),
      initialize_(programs.get("passes/initial_table.comp", defines)),
      list_(programs.get("passes/list_touched.comp", defines)),
      learn_(programs.get("passes/learn.comp", defines)) {}

void QTable::bind() const {
  cells_.bind();
  values_.bind_storage(gpu::BINDING_Q_VALUES);
  values_.bind_fetched(gpu::UNIT_Q_VALUES);
  visits_.bind_storage(gpu::BINDING_Q_VISITS);
  sums_.bind_storage(gpu::BINDING_TARGET_SUMS);
  starts_.bind_storage(gpu::BINDING_ACTION_STARTS);
  starts_.bind_fetched(gpu::UNIT_ACTION_STARTS);
  next_values_.bind_storage(gpu::BINDING_NEXT_VALUES);
  next_values_.bind_fetched(gpu::UNIT_NEXT_VALUES);
  bsdf_shares_.bind_storage(gpu::BINDING_BSDF_SHARES);
  bsdf_shares_.bind_fetched(gpu::UNIT_BSDF_SHARES);
  touched_.bind_storage(gpu::BINDING_TOUCHED_CELLS);
}

void QTable::learn() {
  bind();
  list_->dispatch(groups_of(cells_.count()));
  apply();
}

void QTable::apply() {
  learn_->dispatch_indirect(touched_);
  forget_touched();
}

void QTable::discard() { sums_.clear(); }

void QTable::reset() {
  sums_.clear();
  bind();
  places_.bind_storage(gpu::BINDING_CELL_PLACES);
  initialize_->dispatch(groups_of(cells_.count()));
  prepare_all();
}

void QTable::prepare_all() {
  std::vector<std::uint32_t> list(cells_.count());
  std::iota(list.begin(), list.end(), 0U);
  const gpu::TouchedHead head{groups_of(cells_.count()), 1, 1, cells_.count()};
  touched_.write(0, &head, sizeof(head));
  touched_.write(sizeof(head), list.data(), list.size() * sizeof(list[0]));
  apply();
}

void QTable::forget_touched() {
  const gpu::TouchedHead head{0, 1, 1, 0};
  touched_.write(0, &head, sizeof(head));
}

std::vector<gpu::Buffer*> QTable::learned() {
  return {&values_, &visits_, &sums_, &starts_, &next_values_, &bsdf_shares_};
}

std::size_t QTable::bytes() const {
  return cells_.bytes() + values_.bytes() + visits_.bytes() + sums_.bytes() + starts_.bytes() +
         next_values_.bytes() + bsdf_shares_.bytes() + touched_.bytes() + places_.bytes();
}

std::vector<float> QTable::values() const { return values_.read_all<float>(); }

std::vector<std::uint32_t> QTable::visits() const { return visits_.read_all<std::uint32_t>(); }

void QTable::check_size(std::size_t cells, std::size_t actions) {
  // Every implementation of OpenGL allows so many work groups.
  constexpr std::size_t kMostCells = std::size_t{65535} * gpu::LEARN_GROUP;
  check(cells <= kMostCells,
        "{} cells (two for each site) are more than the {} that one update can reach; lower the "
        "number of sites",
        cells, kMostCells);
  gpu::check_buffer_size(kSums, sum_bytes(cells, actions));
  gpu::check_buffer_size("places of cells", cells * sizeof(gpu::CellPlace));
}

void QTable::set_values(std::span<const float> values) {
  check(values.size() == entries_, "a table of {} values was given for one of {}", values.size(), entries_);
  discard();
  values_.write(0, values.data(), values.size_bytes());
  bind();
  prepare_all();
}

}  // namespace qtrace
