#include "experiments/files/text_table.h"

#include <algorithm>

namespace qtrace::experiments {
namespace {

using Row = std::vector<std::string>;

// Characters, not bytes: continuation bytes of UTF-8 take no room.
std::size_t display_width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::vector<std::size_t> column_widths(const Row& header, const std::vector<Row>& rows) {
  std::vector<std::size_t> widths;
  for (const std::string& cell : header) widths.push_back(std::max<std::size_t>(3, display_width(cell)));
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], display_width(row[i]));
  }
  return widths;
}

std::string padded(const std::string& text, std::size_t width, bool right) {
  const std::string space(width - std::min(width, display_width(text)), ' ');
  return right ? space + text : text + space;
}

Row escaped(const Row& row) {
  Row result;
  for (const std::string& cell : row) {
    std::string text;
    for (const char c : cell) text += c == '|' ? std::string("\\|") : std::string(1, c == '\n' ? ' ' : c);
    result.push_back(text);
  }
  return result;
}

}  // namespace

std::string markdown_table(const Row& header, const std::vector<Row>& rows, std::size_t right_from) {
  std::vector<Row> body;
  for (const Row& row : rows) body.push_back(escaped(row));
  const Row head = escaped(header);
  const std::vector<std::size_t> widths = column_widths(head, body);
  const auto line = [&](const Row& row) {
    std::string text = "|";
    for (std::size_t i = 0; i < row.size(); ++i)
      text += ' ' + padded(row[i], widths[i], i >= right_from) + " |";
    return text + '\n';
  };
  std::string table = line(head) + '|';
  for (std::size_t i = 0; i < head.size(); ++i) {
    table += i >= right_from ? std::string(widths[i] + 1, '-') + ":|" : std::string(widths[i] + 2, '-') + '|';
  }
  table += '\n';
  for (const Row& row : body) table += line(row);
  return table;
}

std::string plain_table(const Row& header, const std::vector<Row>& rows) {
  const std::vector<std::size_t> widths = column_widths(header, rows);
  const auto line = [&](const Row& row) {
    std::string text;
    for (std::size_t i = 0; i < row.size(); ++i) text += padded(row[i], widths[i] + 2, false);
    return text.erase(text.find_last_not_of(' ') + 1) + '\n';
  };
  std::string table = line(header);
  for (const Row& row : rows) table += line(row);
  return table;
}

}  // namespace qtrace::experiments
