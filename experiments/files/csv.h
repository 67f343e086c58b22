// CSV after RFC 4180: comma, CRLF, quotes where needed, one header row. Columns are declared once, as a
// name and a getter.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace qtrace::experiments {

// Nothing: an empty field. Numbers have the 17 digits that read back exactly; true and false are 1 and 0.
using CsvValue = std::variant<std::monostate, double, std::int64_t, std::uint64_t, bool, std::string>;

std::string csv_field(const CsvValue& value);

// An empty field for nothing.
inline CsvValue maybe(const std::optional<double>& value) { return value ? CsvValue(*value) : CsvValue(); }

// One record with its line end.
std::string csv_line(const std::vector<CsvValue>& values);

template <class Row>
struct Column {
  std::string name;  // with its unit
  std::function<CsvValue(const Row&)> get;
};

template <class Row>
std::string csv_text(const std::vector<Column<Row>>& columns, const std::vector<Row>& rows) {
  std::vector<CsvValue> fields;
  for (const auto& column : columns) fields.emplace_back(column.name);
  std::string text = csv_line(fields);
  for (const Row& row : rows) {
    fields.clear();
    for (const auto& column : columns) fields.push_back(column.get(row));
    text += csv_line(fields);
  }
  return text;
}

}  // namespace qtrace::experiments
