// The edge-avoiding à-trous filter (engine/tracer/atrous.h).
#pragma once

#include "engine/core/knob.h"

#include <array>

namespace qtrace {

enum class FilterKind { none, atrous };

template <>
struct EnumNames<FilterKind> {
  static constexpr std::array<std::string_view, 2> values{"none", "atrous"};
};

struct FilterSettings {
  FilterKind kind = FilterKind::none;
  int iterations = 5;
  double sigma_radiance = 32;
  double sigma_normal = 0.3;
  double sigma_position = 0.15;

  bool operator==(const FilterSettings&) const = default;
};

template <class Visitor>
void visit_knobs(Visitor& visit, FilterSettings& filter) {
  visit(KnobInfo{"kind", "", "what is measured beside the plain mean, which stays as it is"}, filter.kind);
  // Holes double: the tenth spans 512 pixels on each side.
  visit(KnobInfo{"iterations", "", "passes; the holes of the kernel double with each", 1, 10},
        filter.iterations);
  visit(KnobInfo{"sigma_radiance", "mean radiances",
                 "difference in radiance / albedo that still mixes in the first pass, as a multiple of the "
                 "image's mean; halved with each pass",
                 1e-6, 1e6},
        filter.sigma_radiance);
  visit(KnobInfo{"sigma_normal", "", "length of the difference of unit normals that still mixes", 1e-6, 1e6},
        filter.sigma_normal);
  visit(KnobInfo{"sigma_position", "view sizes",
                 "distance that still mixes, as a multiple of the root mean square distance of the visible "
                 "points from their centre",
                 1e-6, 1e6},
        filter.sigma_position);
}

}  // namespace qtrace
