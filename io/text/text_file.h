#pragma once

#include <filesystem>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace ldso {

// Text input whose every complaint names the file and the line: all text formats are read through it.

/// A line that is neither blank nor a comment, cut into fields. A field that begins with '#' begins a comment.
struct TextLine {
  int number = 0;  ///< Counted from 1, as editors do.
  std::string text;
  std::vector<std::string> fields;
};

class TextFile {
 public:
  /// Reads the whole file. Fields are separated by blanks and tabs; if `comma_separated` by commas as well.
  /// Throws Error if the file cannot be read.
  explicit TextFile(std::filesystem::path path, bool comma_separated = false);

  const std::filesystem::path& path() const { return path_; }
  const std::vector<TextLine>& lines() const { return lines_; }

  /// Field `index` of a line as a number, which may be NaN or infinite. Throws Error naming file and line.
  double number(const TextLine& line, std::size_t index) const;
  /// As number(), but NaN and infinity are errors.
  double finite_number(const TextLine& line, std::size_t index) const;

  [[noreturn]] void fail(const TextLine& line, const std::string& problem, const std::string& remedy) const;

 private:
  std::filesystem::path path_;
  std::vector<TextLine> lines_;
};

/// A whole text file without the mark that may be in front of UTF-8. Throws Error if it cannot be read or is UTF-16.
std::string read_text(const std::filesystem::path& path);

/// The number that `text` consists of, independent of the locale; false if it is none. "nan" and "inf" are numbers.
bool parse_number(std::string_view text, double& value);

/// For numbers that are read back as they are, whatever the locale.
std::ostringstream number_stream();

/// `text` in lower case (ASCII).
std::string to_lower(std::string text);

}  // namespace ldso
