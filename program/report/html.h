#pragma once
// Pieces of HTML. What is called text is escaped, what is called html is not.

#include <string>
#include <vector>

namespace ldso::html {

/// Safe inside of elements and of attributes in double quotes.
std::string escape(const std::string& text);

/// <tag>text</tag>
std::string element(const std::string& tag, const std::string& text, const std::string& css_class = "");

/// A piece of the page with its headline; `id` is what links name.
std::string section(const std::string& id, const std::string& title, const std::string& html);

/// What opens when it is clicked at.
std::string details(const std::string& summary, const std::string& html);

struct Cell {
  std::string text;
  std::string css_class = "";
  std::string html = "";  ///< Instead of the text.
};

/// Columns are set right but for those whose index is in `left`.
std::string table(const std::vector<std::string>& head, const std::vector<std::vector<Cell>>& rows,
                  const std::vector<std::size_t>& left = {0});

}  // namespace ldso::html
