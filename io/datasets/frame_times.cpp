#include "io/datasets/frame_times.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

#include "io/datasets/time_unit.h"
#include "io/text/text_file.h"
#include "ldso/error.h"
#include "util/format_text.h"

namespace ldso {
namespace {

struct BadExposures {
  int count = 0;
  int first_line = 0;
};

std::optional<double> parse_exposure(const TextFile& file, const TextLine& line, BadExposures& bad) {
  if (line.fields.size() < 3) return std::nullopt;
  const double exposure_ms = file.number(line, 2);
  if (std::isfinite(exposure_ms) && exposure_ms > 0) return exposure_ms;
  if (bad.count++ == 0) bad.first_line = line.number;
  return std::nullopt;
}

/// The last run of digits of an id or a file name without folder and extension, without leading zeros ("cam0/img_0012"
/// gives "12"); nothing if it has no digit.
std::optional<std::string> number_of(const std::string& stem) {
  const std::size_t last = stem.find_last_of("0123456789");
  if (last == std::string::npos) return std::nullopt;
  const std::size_t before = stem.find_last_not_of("0123456789", last);
  std::size_t first = before == std::string::npos ? 0 : before + 1;
  while (first < last && stem[first] == '0') ++first;
  return stem.substr(first, last - first + 1);
}

/// Finds lines by id: first by the same text, then by the same number.
class IdIndex {
 public:
  explicit IdIndex(const FrameTimes& times) {
    for (std::size_t i = 0; i < times.entries.size(); ++i) {
      by_text_.emplace(times.entries[i].id, i);
      if (const auto number = number_of(times.entries[i].id)) by_number_.emplace(*number, i);
    }
  }

  std::optional<std::size_t> find(const std::string& image_name) const {
    const std::string stem = std::filesystem::path(image_name).stem().string();
    if (const auto same_text = by_text_.find(stem); same_text != by_text_.end()) return same_text->second;
    const auto number = number_of(stem);
    if (!number) return std::nullopt;
    const auto same_number = by_number_.find(*number);
    return same_number == by_number_.end() ? std::nullopt : std::optional(same_number->second);
  }

 private:
  std::map<std::string, std::size_t> by_text_;
  std::map<std::string, std::size_t> by_number_;
};

FrameEntry join(const std::string& name, const FrameTime& time) { return {name, time.timestamp, time.exposure_ms}; }

std::vector<FrameEntry> join_by_id(const std::vector<std::string>& names, const FrameTimes& times) {
  const IdIndex index(times);
  std::vector<FrameEntry> frames;
  for (const std::string& name : names) {
    if (const auto line = index.find(name)) frames.push_back(join(name, times.entries[*line]));
  }
  return frames;
}

std::vector<FrameEntry> join_by_order(const std::vector<std::string>& names, const FrameTimes& times) {
  std::vector<FrameEntry> frames;
  for (std::size_t i = 0; i < names.size(); ++i) frames.push_back(join(names[i], times.entries[i]));
  return frames;
}

void to_seconds(FrameTimes& times, std::vector<std::string>& warnings) {
  std::vector<double> values;
  for (const FrameTime& entry : times.entries) values.push_back(entry.timestamp);
  convert_to_seconds(values, times.path, warnings);
  for (std::size_t i = 0; i < values.size(); ++i) times.entries[i].timestamp = values[i];
}

/// Whole numbers of names or ids, in order: nothing if one has none, or if they are not `first`, `first` + 1, ...
std::optional<double> first_of_run(const std::vector<std::string>& stems) {
  std::vector<double> numbers;
  for (const std::string& stem : stems) {
    double value = 0;
    const auto number = number_of(stem);
    if (!number || !parse_number(*number, value) || !std::isfinite(value)) return std::nullopt;
    numbers.push_back(value);
  }
  std::sort(numbers.begin(), numbers.end());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] != numbers.front() + static_cast<double>(i)) return std::nullopt;
  }
  return numbers.empty() ? std::nullopt : std::optional(numbers.front());
}

/// Where images and ids are both counted without a gap, but from different numbers.
struct ShiftedIds {
  double first_image = 0, first_id = 0;
};

std::optional<ShiftedIds> find_shift(const std::vector<std::string>& names, const FrameTimes& times) {
  std::vector<std::string> stems;
  for (const std::string& name : names) stems.push_back(std::filesystem::path(name).stem().string());
  std::vector<std::string> ids;
  for (const FrameTime& time : times.entries) ids.push_back(time.id);
  const auto image = first_of_run(stems);
  const auto id = first_of_run(ids);
  return image && id && *image != *id ? std::optional(ShiftedIds{*image, *id}) : std::nullopt;
}

std::string describe_shift(const ShiftedIds& shift) {
  return "the images are counted from " + format_text("%.0f", shift.first_image) + ", the ids from " +
         format_text("%.0f", shift.first_id);
}

}  // namespace

FrameTimes read_tum_mono_times(const std::filesystem::path& path, std::vector<std::string>& warnings) {
  const TextFile file(path);
  FrameTimes times{path, {}, true};
  BadExposures bad;
  for (const TextLine& line : file.lines()) {
    if (line.fields.size() < 2 || line.fields.size() > 3) {
      file.fail(line, "has " + std::to_string(line.fields.size()) + " columns",
                "expected `id timestamp [exposure_ms]`");
    }
    times.entries.push_back({line.fields[0], file.finite_number(line, 1), parse_exposure(file, line, bad)});
  }
  if (bad.count > 0) {
    warnings.push_back(path.string() + ":" + std::to_string(bad.first_line) + ": " + std::to_string(bad.count) +
                       " exposure times (the first in this line) are NaN, zero or negative; the exposure of these "
                       "frames counts as unknown");
  }
  to_seconds(times, warnings);
  return times;
}

FrameTimes read_kitti_times(const std::filesystem::path& path, std::vector<std::string>& warnings) {
  const TextFile file(path);
  FrameTimes times{path, {}, false};
  for (const TextLine& line : file.lines()) {
    if (line.fields.size() != 1) {
      file.fail(line, "has " + std::to_string(line.fields.size()) + " columns", "expected a timestamp [s] a line");
    }
    times.entries.push_back({std::to_string(times.entries.size()), file.finite_number(line, 0), std::nullopt});
  }
  to_seconds(times, warnings);
  return times;
}

std::vector<FrameEntry> match_times(const std::vector<std::string>& names, const FrameTimes& times,
                                    std::vector<std::string>& warnings) {
  const bool same_number = names.size() == times.entries.size();
  if (same_number && !times.ids_are_written) return join_by_order(names, times);
  std::vector<FrameEntry> by_id = join_by_id(names, times);
  const std::string counts =
      std::to_string(names.size()) + " images and " + std::to_string(times.entries.size()) + " lines of times";
  const bool some_have_none = by_id.size() < std::min(names.size(), times.entries.size());
  const auto shift = some_have_none && times.ids_are_written ? find_shift(names, times) : std::nullopt;
  if (same_number && shift) {
    warnings.push_back(times.path.string() + ": " + describe_shift(*shift) +
                       ", and there are as many: the first image has the first time, and so on");
    return join_by_order(names, times);
  }
  if (shift && !by_id.empty() && std::abs(shift->first_image - shift->first_id) == 1) {
    throw Error(times.path.string(),
                "there are " + counts + ", and " + describe_shift(*shift) + ": which belong together cannot be told",
                "give as many lines as images, or number both alike");
  }
  // Ids that fit in part only are less trustworthy than the order.
  if (same_number && by_id.size() * 2 < names.size()) return join_by_order(names, times);
  if (by_id.empty()) {
    throw Error(times.path.string(), "there are " + counts + ", and the image names do not carry the ids",
                "write one line `id timestamp [exposure_ms]` for each image, or name the images by their ids");
  }
  if (by_id.size() != names.size() || !same_number) {
    warnings.push_back(times.path.string() + ": there are " + counts + "; the " + std::to_string(by_id.size()) +
                       " frames that have both are used");
  }
  return by_id;
}

std::vector<FrameEntry> times_from_rate(const std::vector<std::string>& names, double fps) {
  if (!(std::isfinite(fps) && fps > 0)) throw Error("--fps", "must be a positive number", "30, for instance");
  std::vector<FrameEntry> frames;
  for (const std::string& name : names) {
    frames.push_back({name, static_cast<double>(frames.size()) / fps, std::nullopt});
  }
  return frames;
}

}  // namespace ldso
