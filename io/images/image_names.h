#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ldso {

// The order of a sequence's images is that of their names, and which of several kinds that lie together is meant is
// told by a pattern.

/// Order of names in which runs of digits compare as numbers ("9.png" before "10.png").
bool natural_less(const std::string& a, const std::string& b);

/// Sorts by natural_less(), or, where all names are times in seconds with decimals of different length
/// ("1305031102.1.png" after "1305031102.05.png"), by time.
void sort_image_names(std::vector<std::string>& names);

/// Whether a name is of a pattern: `%d` (or `%06d`) stands for a number, `*` for any text, `?` for any character,
/// `%%` for a percent sign. Capitals count as small letters. The folder of a name only counts if the pattern has one.
bool matches_pattern(std::string_view name, std::string_view pattern);

/// Images of one kind: their names differ in their numbers only.
struct ImageFamily {
  std::string pattern;  ///< As matches_pattern() takes it: "frame-%d.color.png".
  int count = 0;
};

/// The kinds of images among `names`. Names without any number are one kind.
std::vector<ImageFamily> image_families(const std::vector<std::string>& names);

/// Those of `names` that match `pattern`; without one (empty) all, if they are of one kind. Throws Error naming the
/// patterns if they are not, or if none matches; `location` is what messages call the folder.
std::vector<std::string> choose_images(const std::vector<std::string>& names, const std::string& pattern,
                                       const std::string& location);

}  // namespace ldso
