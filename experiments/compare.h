// `qtrace compare`: the errors of one image file against another.
#pragma once

#include <filesystem>
#include <string>

namespace qtrace::experiments {

// A table of all metrics of `image` against `reference`; the noise floor only where the reference has
// variance channels. Throws Error that names the file: unreadable, no R, G, B, sizes that differ.
std::string compare_files(const std::filesystem::path& image, const std::filesystem::path& reference);

}  // namespace qtrace::experiments
