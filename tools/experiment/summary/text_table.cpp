#include "experiment/summary/text_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "experiment/results/csv.h"
#include "util/format_text.h"

namespace ldso {
namespace {

/// Characters of a UTF-8 text.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::string markdown_escape(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|' || c == '\\' || c == '<' || c == '*') escaped += '\\';
    escaped += c == '\n' ? ' ' : c;
  }
  return escaped;
}

std::string markdown_cell(const TableCell& cell) {
  const std::string text = markdown_escape(cell.text);
  return cell.best ? "**" + text + "**" : text;
}

std::string padded(const std::string& text, std::size_t width, bool left) {
  const std::string blanks(width - std::min(width, width_of(text)), ' ');
  return left ? text + blanks : blanks + text;
}

std::string markdown_line(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) {
  std::string line = "|";
  for (std::size_t i = 0; i < cells.size(); ++i)
    line.append(" ").append(padded(cells[i], widths[i], i == 0)).append(" |");
  return line + "\n";
}

std::string latex_escape(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
      case '%':
      case '$':
      case '#':
      case '_':
      case '{':
      case '}':
        escaped += std::string("\\") + c;
        break;
      case '\\':
        escaped += "\\textbackslash{}";
        break;
      case '~':
        escaped += "\\textasciitilde{}";
        break;
      case '^':
        escaped += "\\textasciicircum{}";
        break;
      case '<':
      case '>':
        escaped += std::string("$") + c + "$";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

template <class Cells, class Text>
std::string latex_line(const Cells& cells, Text text) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) line += (i > 0 ? " & " : "") + text(cells[i]);
  return line + " \\\\\n";
}

std::string latex_cell(const TableCell& cell) {
  const std::string text = latex_escape(cell.text);
  return cell.best ? "\\textbf{" + text + "}" : text;
}

}  // namespace

std::string table_csv(const TextTable& table) {
  std::string text = csv_line(table.head);
  for (const TableRow& row : table.rows) {
    CsvRow fields;
    for (const TableCell& cell : row) fields.push_back(cell.text);
    text += csv_line(fields);
  }
  return text;
}

std::string table_markdown(const TextTable& table) {
  std::vector<std::vector<std::string>> lines(1);
  for (const std::string& title : table.head) lines.front().push_back(markdown_escape(title));
  for (const TableRow& row : table.rows) {
    lines.emplace_back();
    for (const TableCell& cell : row) lines.back().push_back(markdown_cell(cell));
  }
  std::vector<std::size_t> widths(table.head.size(), 3);
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], width_of(line[i]));
  }
  std::string text = markdown_line(lines.front(), widths) + "|";
  for (std::size_t i = 0; i < widths.size(); ++i) {
    text.append(" ").append(widths[i] - (i == 0 ? 0 : 1), '-').append(i == 0 ? " |" : ": |");
  }
  text += "\n";
  for (std::size_t i = 1; i < lines.size(); ++i) text += markdown_line(lines[i], widths);
  return text;
}

std::string table_latex(const TextTable& table) {
  std::string text = "\\begin{table}\n  \\centering\n  \\caption{" + latex_escape(table.caption) +
                     "}\n  \\label{table:" + table.name + "}\n  \\begin{tabular}{l" +
                     std::string(table.head.size() > 0 ? table.head.size() - 1 : 0, 'r') + "}\n    \\hline\n    ";
  text += latex_line(table.head, latex_escape) + "    \\hline\n";
  for (const TableRow& row : table.rows) text += "    " + latex_line(row, latex_cell);
  return text + "    \\hline\n  \\end{tabular}\n\\end{table}\n";
}

std::string table_number(const std::optional<double>& value) {
  if (!value || std::isnan(*value)) return "-";
  if (std::isinf(*value)) return "failed";
  const double size = std::abs(*value);
  if (size != 0 && (size < 1e-4 || size >= 1e6)) return format_text("%.3e", *value);
  const int digits = size > 0 ? static_cast<int>(std::floor(std::log10(size))) + 1 : 1;
  return format_text("%.*f", std::clamp(4 - digits, 0, 7), *value);
}

}  // namespace ldso
