#include "io/images/image_names.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "io/text/text_file.h"
#include "ldso/error.h"

namespace ldso {
namespace {

constexpr std::string_view kDigits = "0123456789";

/// Digits before the point of a time since 1970: with them a name is a time whatever its decimals look like.
constexpr std::size_t kDigitsOfEpoch = 9;

/// More kinds than these, on average of less than two images, are names that say nothing (hashes).
constexpr std::size_t kMostFamilies = 12;

/// Cameras or streams that a single digit in front of the number may tell apart.
constexpr std::size_t kMostStreams = 10;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Cuts the run of digits at `position` without its leading zeros and moves `position` behind it.
std::string_view cut_number(std::string_view text, std::size_t& position) {
  while (position < text.size() && text[position] == '0') ++position;
  const std::size_t begin = position;
  while (position < text.size() && is_digit(text[position])) ++position;
  return text.substr(begin, position - begin);
}

std::string_view folder_of(std::string_view name) {
  const std::size_t slash = name.find_last_of('/');
  return slash == std::string_view::npos ? std::string_view() : name.substr(0, slash + 1);
}

/// A name that is a time: folder and letters in front, whole seconds, decimals without the point.
struct SecondsName {
  std::string_view before, whole, decimals;
};

/// "cam0/t_1305031102.175.png": nothing if the name is no number with a decimal point.
std::optional<SecondsName> parse_seconds(std::string_view name) {
  const std::string_view folder = folder_of(name);
  const std::string_view file = name.substr(folder.size());
  const std::size_t extension = file.find_last_of('.');
  const std::string_view stem = file.substr(0, extension);
  const std::size_t first = stem.find_first_of(kDigits);
  if (first == std::string_view::npos) return std::nullopt;
  const std::size_t point = std::min(stem.find_first_not_of(kDigits, first), stem.size());
  SecondsName result{name.substr(0, folder.size() + first), stem.substr(first, point - first), {}};
  if (point == stem.size()) return result.whole.size() < kDigitsOfEpoch ? std::nullopt : std::optional(result);
  result.decimals = stem.substr(point + 1);
  const bool is_number = stem[point] == '.' && !result.decimals.empty() &&
                         result.decimals.find_first_not_of(kDigits) == std::string_view::npos;
  return is_number ? std::optional(result) : std::nullopt;
}

/// Whether names are times whose decimals differ in length. "1.9", "1.10" are numbers of parts rather than times: a
/// time is written without a zero at its end, but for "1.0", or it is clearly one by its length.
bool are_seconds(const std::vector<std::string>& names) {
  std::set<std::size_t> lengths;
  std::set<std::string_view> fronts;
  for (const std::string& name : names) {
    const auto seconds = parse_seconds(name);
    if (!seconds) return false;
    const bool ends_in_zero = seconds->decimals.size() > 1 && seconds->decimals.back() == '0';
    if (ends_in_zero && seconds->whole.size() < kDigitsOfEpoch) return false;
    lengths.insert(seconds->decimals.size());
    fronts.insert(seconds->before);
  }
  return lengths.size() > 1 && fronts.size() == 1;
}

bool earlier(const std::string& a, const std::string& b) {
  const SecondsName x = *parse_seconds(a);
  const SecondsName y = *parse_seconds(b);
  std::size_t i = 0;
  std::size_t j = 0;
  const std::string_view whole_x = cut_number(x.whole, i);
  const std::string_view whole_y = cut_number(y.whole, j);
  if (whole_x.size() != whole_y.size()) return whole_x.size() < whole_y.size();
  if (whole_x != whole_y) return whole_x < whole_y;
  return x.decimals != y.decimals ? x.decimals < y.decimals : a < b;
}

/// The end of a `%d` or `%06d` that stands at `position`; nothing if none does.
std::optional<std::size_t> end_of_number_mark(std::string_view pattern, std::size_t position) {
  if (pattern[position] != '%') return std::nullopt;
  const std::size_t end = pattern.find_first_not_of(kDigits, position + 1);
  return end != std::string_view::npos && pattern[end] == 'd' ? std::optional(end + 1) : std::nullopt;
}

/// The end of the mark or character at `position`: "%%" is one character, a percent sign.
std::size_t end_of_mark(std::string_view pattern, std::size_t position) {
  if (const auto number_end = end_of_number_mark(pattern, position)) return *number_end;
  return position + (pattern.substr(position, 2) == "%%" ? 2 : 1);
}

/// Where the first number of `pattern` is; its size if there is none.
std::size_t first_number_mark(std::string_view pattern) {
  std::size_t position = 0;
  while (position < pattern.size() && !end_of_number_mark(pattern, position)) {
    position = end_of_mark(pattern, position);
  }
  return position;
}

/// A part of a name as a pattern that means itself.
std::string escape_percents(std::string_view text) {
  std::string escaped;
  for (const char c : text) escaped += c == '%' ? "%%" : std::string(1, c);
  return escaped;
}

/// Whether `pattern` matches the whole of `name`: `matches[i]` says whether what was seen of the pattern matches the
/// first i characters of the name, so that no pattern takes more than its length times that of the name.
bool matches_whole(std::string_view name, std::string_view pattern) {
  std::vector<bool> matches(name.size() + 1, false);
  matches[0] = true;
  for (std::size_t position = 0; position < pattern.size();) {
    std::vector<bool> next(name.size() + 1, false);
    const auto number_end = end_of_number_mark(pattern, position);
    const char mark = pattern[position];
    for (std::size_t i = 0; i <= name.size(); ++i) {
      if (number_end) {
        next[i] = i > 0 && is_digit(name[i - 1]) && (next[i - 1] || matches[i - 1]);
      } else if (mark == '*') {
        next[i] = matches[i] || (i > 0 && next[i - 1]);
      } else {
        next[i] = i > 0 && matches[i - 1] && (mark == '?' || mark == name[i - 1]);
      }
    }
    matches = std::move(next);
    position = end_of_mark(pattern, position);
  }
  return matches[name.size()];
}

/// "cam0/a12_7.PNG" gives "cam0/a%d_%d.png".
std::string pattern_of(std::string_view name) {
  const std::string_view folder = folder_of(name);
  const std::string_view file = name.substr(folder.size());
  const std::size_t extension = std::min(file.find_last_of('.'), file.size());
  std::string pattern = escape_percents(folder);
  for (std::size_t i = 0; i < extension;) {
    const std::size_t end = std::min(file.find_first_not_of(kDigits, i), extension);
    pattern += end > i ? "%d" : escape_percents(file.substr(i, 1));
    i = std::max(end, i + 1);
  }
  return pattern + escape_percents(to_lower(std::string(file.substr(extension))));
}

/// One kind for names that cannot be told apart by numbers: none in them, or times some of which are whole seconds.
std::string family_of(const std::string& name) {
  std::string pattern = pattern_of(name);
  const std::string_view folder = folder_of(name);
  const std::size_t extension = std::min(pattern.find_last_of('.'), pattern.size());
  if (first_number_mark(pattern) == pattern.size()) return escape_percents(folder) + "*" + pattern.substr(extension);
  if (const auto seconds = parse_seconds(name); seconds && seconds->whole.size() >= kDigitsOfEpoch)
    return escape_percents(seconds->before) + "*" + pattern.substr(extension);
  return pattern;
}

/// Where in a file's name its first number is, if it is one of two and has a single digit; npos otherwise.
std::size_t stream_digit(const std::string& name) {
  const std::size_t begin = folder_of(name).size();
  const std::size_t first = name.find_first_of(kDigits, begin);
  if (first == std::string::npos || first + 1 >= name.size() || is_digit(name[first + 1])) return std::string::npos;
  const std::size_t second = name.find_first_of(kDigits, first + 1);
  const std::size_t extension = name.find_last_of('.');
  if (second == std::string::npos || second > extension || name.substr(first + 1, second - first - 1) == ".")
    return std::string::npos;
  const std::size_t end = name.find_first_not_of(kDigits, second);
  return name.find_first_of(kDigits, end) < extension ? std::string::npos : first;
}

/// "cam0_7.png" and "cam1_7.png" are two kinds if the same numbers follow both: (digit, count) of each, empty if not.
std::map<char, int> streams_of(const std::vector<std::string>& names) {
  std::map<char, std::set<std::string>> rest;
  for (const std::string& name : names) {
    const std::size_t digit = stream_digit(name);
    if (digit == std::string::npos) return {};
    rest[name[digit]].insert(name.substr(digit + 1));
  }
  std::set<std::string> distinct;
  std::map<char, int> counts;
  for (const auto& [digit, follows] : rest) {
    distinct.insert(follows.begin(), follows.end());
    counts[digit] = static_cast<int>(follows.size());
  }
  const bool repeat = distinct.size() * 3 < names.size() * 2;
  return repeat && rest.size() > 1 && rest.size() <= kMostStreams ? counts : std::map<char, int>();
}

std::string describe_families(const std::vector<ImageFamily>& families) {
  std::string text;
  for (const ImageFamily& family : families) {
    text += (text.empty() ? "" : ", ") + family.pattern + " (" + std::to_string(family.count) + ")";
  }
  return text;
}

}  // namespace

bool natural_less(const std::string& a, const std::string& b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string_view number_a = cut_number(a, i);
      const std::string_view number_b = cut_number(b, j);
      if (number_a.size() != number_b.size()) return number_a.size() < number_b.size();
      if (number_a != number_b) return number_a < number_b;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;  // Equal but for leading zeros.
}

void sort_image_names(std::vector<std::string>& names) {
  std::sort(names.begin(), names.end(), are_seconds(names) ? earlier : natural_less);
}

bool matches_pattern(std::string_view name, std::string_view pattern) {
  const bool whole = pattern.find('/') != std::string_view::npos;
  // In small letters, since cameras write .JPG and people .jpg.
  return matches_whole(to_lower(std::string(whole ? name : name.substr(folder_of(name).size()))),
                       to_lower(std::string(pattern)));
}

std::vector<ImageFamily> image_families(const std::vector<std::string>& names) {
  std::map<std::string, std::vector<std::string>> members;
  for (const std::string& name : names) members[family_of(name)].push_back(name);
  std::vector<ImageFamily> families;
  for (const auto& [pattern, of_pattern] : members) {
    const std::map<char, int> streams = streams_of(of_pattern);
    if (streams.empty()) families.push_back({pattern, static_cast<int>(of_pattern.size())});
    for (const auto& [digit, count] : streams) {
      std::string own = pattern;
      families.push_back({own.replace(first_number_mark(own), 2, 1, digit), count});
    }
  }
  return families;
}

std::vector<std::string> choose_images(const std::vector<std::string>& names, const std::string& pattern,
                                       const std::string& location) {
  if (pattern.empty()) {
    const std::vector<ImageFamily> families = image_families(names);
    if (families.size() < 2 || (families.size() > kMostFamilies && families.size() * 2 > names.size())) return names;
    throw Error(location, "images of several kinds lie together: " + describe_families(families),
                "choose one with --pattern '" + families.front().pattern + "', or all with --pattern '*'");
  }
  std::vector<std::string> chosen;
  std::copy_if(names.begin(), names.end(), std::back_inserter(chosen),
               [&](const std::string& name) { return matches_pattern(name, pattern); });
  if (!chosen.empty() || names.empty()) return chosen;
  throw Error("--pattern " + pattern,
              "no image of " + location + " matches: there are " + describe_families(image_families(names)),
              "%d stands for a number, * for any text");
}

}  // namespace ldso
