// "Did you mean ...?" for keys and names that users type.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace qtrace::experiments {

// Levenshtein distance: insertions, deletions and replacements that turn `a` into `b`.
std::size_t edit_distance(std::string_view a, std::string_view b);

// The candidate nearest to `word`, or empty where none is near. Dotted keys are compared whole and by
// their last part, so that a key at the wrong level is found too.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

// "; did you mean 'candidate'?", or empty where no candidate is near.
std::string suggestion(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace qtrace::experiments
