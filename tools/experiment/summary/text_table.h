#pragma once
// A table of text cells as CSV, Markdown and LaTeX.

#include <optional>
#include <string>
#include <vector>

namespace ldso {

struct TableCell {
  std::string text;
  bool best = false;  ///< Set in bold, but for CSV.
};
using TableRow = std::vector<TableCell>;

struct TextTable {
  std::string name;     ///< Of its files and its label.
  std::string caption;  ///< With the unit.
  std::vector<std::string> head;
  std::vector<TableRow> rows;  ///< As long as the head.
};

std::string table_csv(const TextTable& table);

/// Columns padded to equal width, so that it reads well as plain text, too. The first is set left, the others right.
std::string table_markdown(const TextTable& table);

/// A `table` with `tabular` that needs no packages.
std::string table_latex(const TextTable& table);

/// Four significant digits, no exponent between 0.0001 and 1,000,000; "failed" if infinite, "-" if there is none.
std::string table_number(const std::optional<double>& value);

}  // namespace ldso
