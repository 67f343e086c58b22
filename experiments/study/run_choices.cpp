#include "experiments/study/run_choices.h"

#include <fmt/format.h>

namespace qtrace::experiments {

std::string Shard::text() const { return fmt::format("{}-of-{}", index, count); }

}  // namespace qtrace::experiments
