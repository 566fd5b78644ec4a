#include "report/html.h"

#include <algorithm>

#include "evaluation/svg_chart.h"

namespace ldso::html {
namespace {

std::string class_attribute(const std::string& css_class) {
  return css_class.empty() ? "" : " class=\"" + css_class + "\"";
}

}  // namespace

std::string escape(const std::string& text) {
  std::string clean;
  for (const char c : text) {
    // No control character has a place in a page.
    const bool is_control = static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t';
    clean += is_control ? ' ' : c;
  }
  return xml_escape(clean);
}

std::string element(const std::string& tag, const std::string& text, const std::string& css_class) {
  return "<" + tag + class_attribute(css_class) + ">" + escape(text) + "</" + tag + ">";
}

std::string section(const std::string& id, const std::string& title, const std::string& html) {
  return "<section id=\"" + id + "\">\n" + element("h2", title) + "\n" + html + "</section>\n";
}

std::string details(const std::string& summary, const std::string& html) {
  return "<details>" + element("summary", summary) + "\n" + html + "</details>\n";
}

std::string table(const std::vector<std::string>& head, const std::vector<std::vector<Cell>>& rows,
                  const std::vector<std::size_t>& left) {
  const auto side = [&](std::size_t column) {
    return std::find(left.begin(), left.end(), column) != left.end() ? std::string("left") : std::string();
  };
  std::string html = "<div class=\"table\"><table>\n<tr>";
  for (std::size_t i = 0; i < head.size(); ++i) html += element("th", head[i], side(i));
  html += "</tr>\n";
  for (const std::vector<Cell>& row : rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const Cell& cell = row[i];
      const std::string classes = cell.css_class + (cell.css_class.empty() || side(i).empty() ? "" : " ") + side(i);
      html += "<td" + class_attribute(classes) + ">" + (cell.html.empty() ? escape(cell.text) : cell.html) + "</td>";
    }
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

}  // namespace ldso::html
