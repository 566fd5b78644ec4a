#pragma once
// The index of a summary: summary.md and index.html with all tables and figures.

#include <string>
#include <vector>

#include "experiment/summary/text_table.h"

namespace ldso {

struct FigureLink {
  std::string file;  ///< Relative to the page, without extension.
  std::string caption;
  bool has_png = false;
};

struct SummarySection {
  std::string title;
  std::vector<TextTable> tables;
  std::vector<FigureLink> figures;
};

struct SummaryPage {
  std::string title;
  std::vector<std::string> lines;  ///< How many runs there are in which state, ...
  std::vector<std::string> warnings;
  std::vector<SummarySection> sections;
};

std::string summary_markdown(const SummaryPage& page);
/// One file without scripts; figures are read from their SVG files.
std::string summary_html(const SummaryPage& page);

}  // namespace ldso
