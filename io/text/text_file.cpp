#include "io/text/text_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <limits>
#include <locale>
#include <utility>

#include "ldso/error.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

/// That some editors put in front of UTF-8.
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

bool is_separator(char c, bool comma_separated) {
  return c == ' ' || c == '\t' || c == '\r' || (comma_separated && c == ',');
}

std::vector<std::string> split(std::string_view text, bool comma_separated) {
  std::vector<std::string> fields;
  std::size_t begin = 0;
  while (begin < text.size()) {
    if (is_separator(text[begin], comma_separated)) {
      ++begin;
      continue;
    }
    std::size_t end = begin;
    while (end < text.size() && !is_separator(text[end], comma_separated)) ++end;
    fields.emplace_back(text.substr(begin, end - begin));
    begin = end;
  }
  return fields;
}

}  // namespace

bool parse_number(std::string_view text, double& value) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const char* end = text.data() + text.size();
  const auto [parsed_end, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && parsed_end == end;
}

std::string to_lower(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

std::ostringstream number_stream() {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << std::setprecision(std::numeric_limits<double>::max_digits10);
  return out;
}

std::string read_text(const std::filesystem::path& path) {
  std::string content = read_file(path);
  if (content.starts_with("\xff\xfe") || content.starts_with("\xfe\xff"))
    throw Error(path.string(), "is text in UTF-16", "save it as UTF-8");
  if (content.starts_with(kByteOrderMark)) content.erase(0, kByteOrderMark.size());
  return content;
}

TextFile::TextFile(std::filesystem::path path, bool comma_separated) : path_(std::move(path)) {
  const std::string content = read_text(path_);
  std::string_view rest = content;
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    const std::string_view text = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    std::vector<std::string> fields = split(text, comma_separated);
    const auto is_comment = [](const std::string& field) { return field.front() == '#'; };
    fields.erase(std::find_if(fields.begin(), fields.end(), is_comment), fields.end());
    if (fields.empty()) continue;
    lines_.push_back({number, std::string(text), std::move(fields)});
  }
}

void TextFile::fail(const TextLine& line, const std::string& problem, const std::string& remedy) const {
  throw Error(path_.string() + ":" + std::to_string(line.number), problem, remedy);
}

double TextFile::number(const TextLine& line, std::size_t index) const {
  if (index >= line.fields.size()) {
    fail(line, "has " + std::to_string(line.fields.size()) + " fields",
         "at least " + std::to_string(index + 1) + " are expected");
  }
  double value = 0;
  if (!parse_number(line.fields[index], value)) {
    fail(line, "'" + line.fields[index] + "' is not a number",
         "a number is expected in column " + std::to_string(index + 1));
  }
  return value;
}

double TextFile::finite_number(const TextLine& line, std::size_t index) const {
  const double value = number(line, index);
  if (!std::isfinite(value)) {
    fail(line, "'" + line.fields[index] + "' is not finite",
         "a finite number is expected in column " + std::to_string(index + 1));
  }
  return value;
}

}  // namespace ldso
