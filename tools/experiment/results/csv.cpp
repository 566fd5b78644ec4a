#include "experiment/results/csv.h"

#include <utility>

#include "ldso/error.h"

namespace ldso {
namespace {

std::string quoted_if_needed(const std::string& field) {
  if (field.find_first_of(",\"\r\n") == std::string::npos) return field;
  std::string quoted = "\"";
  for (const char c : field) {
    quoted += c;
    if (c == '"') quoted += c;
  }
  return quoted + '"';
}

/// Takes one field from the front of `text`, up to the comma or the end of the line, which stay.
std::string take_field(std::string_view& text) {
  std::string field;
  bool in_quotes = false;
  while (!text.empty()) {
    const char c = text.front();
    if (!in_quotes && (c == ',' || c == '\n')) return field;
    text.remove_prefix(1);
    if (c != '"') {
      if (in_quotes || c != '\r') field += c;
    } else if (in_quotes && !text.empty() && text.front() == '"') {
      field += c;
      text.remove_prefix(1);
    } else {
      in_quotes = !in_quotes;
    }
  }
  if (in_quotes) throw Error("csv", "a quote is never closed", "");
  return field;
}

}  // namespace

std::string csv_line(const CsvRow& row) {
  std::string line;
  for (std::size_t i = 0; i < row.size(); ++i) line.append(i > 0 ? "," : "").append(quoted_if_needed(row[i]));
  return line + "\n";
}

std::vector<CsvRow> parse_csv(std::string_view text) {
  std::vector<CsvRow> rows;
  while (!text.empty()) {
    CsvRow row = {take_field(text)};
    while (!text.empty() && text.front() == ',') {
      text.remove_prefix(1);
      row.push_back(take_field(text));
    }
    if (!text.empty()) text.remove_prefix(1);  // The newline.
    if (row.size() > 1 || !row.front().empty()) rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace ldso
