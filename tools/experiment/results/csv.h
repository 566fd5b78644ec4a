#pragma once
// Comma-separated values as RFC 4180 has them.

#include <string>
#include <string_view>
#include <vector>

namespace ldso {

using CsvRow = std::vector<std::string>;

/// The fields of a row, in quotes where that is needed, with a newline at the end.
std::string csv_line(const CsvRow& row);

/// Rows of a text; empty lines are left out. Throws ldso::Error if a quote is never closed.
std::vector<CsvRow> parse_csv(std::string_view text);

}  // namespace ldso
