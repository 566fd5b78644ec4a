#include "experiment/summary/summary_page.h"

#include "evaluation/svg_chart.h"

namespace ldso {
namespace {

constexpr const char* kHead =
    "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width\">\n<style>\n"
    "body { font-family: Helvetica, Arial, sans-serif; margin: 2em auto; max-width: 80em; padding: 0 1em; color: #222 "
    "}\n"
    "table { border-collapse: collapse; font-size: 0.85em; font-variant-numeric: tabular-nums }\n"
    "th, td { padding: 0.25em 0.6em; text-align: right; vertical-align: top; border-bottom: 1px solid #ddd }\n"
    "th { vertical-align: bottom } td { white-space: nowrap } small { color: #555 }\n"
    "th:first-child, td:first-child { text-align: left }\n"
    ".reasons td { text-align: left; white-space: normal }\n"
    "figure { margin: 1em 0 2em } img { max-width: 100% } figcaption, caption { color: #555; text-align: left }\n"
    "caption { padding-bottom: 0.4em; white-space: nowrap }\n"
    ".table { overflow-x: auto; margin: 1em 0 2em }\n";

/// A figure, and below it, smaller, what is said of it in brackets.
std::string html_cell(const TableCell& cell) {
  const std::size_t note = cell.text.find(" (");
  const std::string value = xml_escape(cell.text.substr(0, note));
  const std::string marked = cell.best ? "<b>" + value + "</b>" : value;
  return note == std::string::npos ? marked
                                   : marked + "<br><small>" + xml_escape(cell.text.substr(note + 1)) + "</small>";
}

std::string html_table(const TextTable& table) {
  const bool is_text = table.name == "problems";
  std::string html = "<div class=\"table\"><table" + std::string(is_text ? " class=\"reasons\"" : "") + "><caption>" +
                     xml_escape(table.caption) + "</caption>\n<tr>";
  for (const std::string& title : table.head) html += "<th>" + xml_escape(title) + "</th>";
  html += "</tr>\n";
  for (const TableRow& row : table.rows) {
    html += "<tr>";
    for (const TableCell& cell : row) html += "<td>" + (is_text ? xml_escape(cell.text) : html_cell(cell)) + "</td>";
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string html_figure(const FigureLink& figure) {
  const std::string svg = xml_escape(figure.file + ".svg");
  std::string html = "<figure><a href=\"" + svg + "\"><img loading=\"lazy\" src=\"" + svg + "\" alt=\"" +
                     xml_escape(figure.caption) + "\"></a><figcaption>" + xml_escape(figure.caption) + " (<a href=\"" +
                     svg + "\">svg</a>";
  if (figure.has_png) html += ", <a href=\"" + xml_escape(figure.file + ".png") + "\">png</a>";
  return html + ")</figcaption></figure>\n";
}

std::string html_list(const std::vector<std::string>& lines) {
  std::string html = "<ul>\n";
  for (const std::string& line : lines) html += "<li>" + xml_escape(line) + "</li>\n";
  return html + "</ul>\n";
}

std::string markdown_list(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += "- " + line + "\n";
  return text + "\n";
}

}  // namespace

std::string summary_markdown(const SummaryPage& page) {
  std::string text = "# " + page.title + "\n\n" + markdown_list(page.lines);
  if (!page.warnings.empty()) text += "Warnings:\n\n" + markdown_list(page.warnings);
  for (const SummarySection& section : page.sections) {
    text += "## " + section.title + "\n\n";
    for (const TextTable& table : section.tables) text += table.caption + "\n\n" + table_markdown(table) + "\n";
    for (const FigureLink& figure : section.figures) {
      text += "![" + figure.caption + "](" + figure.file + (figure.has_png ? ".png" : ".svg") + ")\n\n";
    }
  }
  return text;
}

std::string summary_html(const SummaryPage& page) {
  std::string html = std::string(kHead) + "</style>\n<title>" + xml_escape(page.title) +
                     "</title>\n</head>\n<body>\n<h1>" + xml_escape(page.title) + "</h1>\n" + html_list(page.lines);
  if (!page.warnings.empty()) html += "<p>Warnings:</p>\n" + html_list(page.warnings);
  for (const SummarySection& section : page.sections) {
    html += "<h2>" + xml_escape(section.title) + "</h2>\n";
    for (const TextTable& table : section.tables) html += html_table(table);
    for (const FigureLink& figure : section.figures) html += html_figure(figure);
  }
  return html + "</body>\n</html>\n";
}

}  // namespace ldso
