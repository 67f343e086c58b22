#include "experiments/files/csv.h"

#include <fmt/format.h>

namespace qtrace::experiments {
namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

struct FieldText {
  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(double value) const { return fmt::format("{:.17g}", value); }
  std::string operator()(std::int64_t value) const { return std::to_string(value); }
  std::string operator()(std::uint64_t value) const { return std::to_string(value); }
  std::string operator()(bool value) const { return value ? "1" : "0"; }
  std::string operator()(const std::string& value) const { return quoted(value); }
};

}  // namespace

std::string csv_field(const CsvValue& value) { return std::visit(FieldText{}, value); }

std::string csv_line(const std::vector<CsvValue>& values) {
  std::string line;
  for (std::size_t i = 0; i < values.size(); ++i) line += (i == 0 ? "" : ",") + csv_field(values[i]);
  return line + "\r\n";
}

}  // namespace qtrace::experiments
