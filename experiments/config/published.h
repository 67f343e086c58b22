// Figures of a publication that a table shows beside the measured ones.
#pragma once

#include "experiments/config/json_knobs.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace qtrace::experiments {

// Milliseconds per frame by configuration ("simple / RL").
struct PublishedTimes {
  std::vector<std::pair<std::string, double>> by_configuration;

  const double* find(const std::string& configuration) const;  // null where nothing was published
};

template <>
struct KnobType<PublishedTimes> {
  static std::string describe(const KnobInfo&);
  static void read(const Json& json, const KnobInfo& info, const std::string& path, PublishedTimes& times);
  static Json write(const PublishedTimes& times);
  static Json schema(const KnobInfo&);
};

struct Published {
  std::string source;
  std::string note;
  PublishedTimes ms_per_frame;
  std::array<std::string, 2> ratio;
};

template <class Visitor>
void visit_knobs(Visitor& visit, Published& published) {
  visit(KnobInfo{"source", "", "where the figures come from"}, published.source);
  visit(KnobInfo{"note", "", "one sentence on what is comparable; the table ends with it"}, published.note);
  visit(KnobInfo{"ms_per_frame", "ms", "published times by configuration: axis labels joined by ' / '"},
        published.ms_per_frame);
  visit(KnobInfo{"ratio", "", "two labels of one axis: the table shows first / second"}, published.ratio);
}

}  // namespace qtrace::experiments
