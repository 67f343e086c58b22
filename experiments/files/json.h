// JSON as configs use it: read strictly, addressed by dotted paths, merged, and made canonical for hashes.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace qtrace::experiments {

using Json = nlohmann::ordered_json;  // keeps the order in which a config names things

// Comments are allowed. Throws Error with line and column: bad syntax, a key that an object has twice,
// nesting deeper than 16, more than 4096 keys in one object, numbers outside double precision.
Json parse_json(const std::string& text);

// The same for a file; every error names it.
Json read_json_file(const std::filesystem::path& file);

// The value as short text for messages and labels: strings without quotes only if `bare`.
std::string show(const Json& value, bool bare = false);

// Sets object["a"]["b"] for the path "a.b"; objects on the way are made where they are missing.
// Throws Error where something on the way is not an object.
void set_path(Json& object, std::string_view path, const Json& value);

// Merges `overrides` into `object`: keys may be dotted, nested objects are merged, all else is replaced.
void merge(Json& object, const Json& overrides);

// Dotted paths of all values that are not objects with members, in order.
std::vector<std::string> leaf_paths(const Json& object);

// Whether setting one path touches the other: equal, or one inside the other ("rl" and "rl.update").
bool paths_overlap(std::string_view a, std::string_view b);

// Keys sorted, no white space, shortest numbers that read back exactly: equal text for equal content.
std::string canonical_text(const Json& value);

std::string json_text(const Json& json);  // indented, with a final line break

// The same as a file; whole or not at all.
void write_json(const std::filesystem::path& file, const Json& json);

}  // namespace qtrace::experiments
