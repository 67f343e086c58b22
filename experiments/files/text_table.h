// Tables that read well on a terminal and are valid Markdown.
#pragma once

#include <string>
#include <vector>

namespace qtrace::experiments {

// `right_from`: the first of the right-aligned columns (numbers). '|' in cells is escaped.
std::string markdown_table(const std::vector<std::string>& header,
                           const std::vector<std::vector<std::string>>& rows, std::size_t right_from);

// Columns divided by two spaces, without lines; for lists on the terminal.
std::string plain_table(const std::vector<std::string>& header,
                        const std::vector<std::vector<std::string>>& rows);

}  // namespace qtrace::experiments
