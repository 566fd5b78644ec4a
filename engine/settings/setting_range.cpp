#include "settings/setting_range.h"

#include <locale>
#include <sstream>

#include "ldso/error.h"

namespace ldso {

std::string number_text(double value) {
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream.precision(12);
  stream << value;
  return stream.str();
}

std::string allowed_text(const SettingInfo& info) {
  const bool is_open = info.largest >= kLargestSetting;
  std::string text =
      is_open ? "at least " + number_text(info.least) : number_text(info.least) + " to " + number_text(info.largest);
  if (!info.unit.empty()) text.append(" ").append(info.unit);
  return text;
}

void check_range(const std::string& where, double value, const SettingInfo& info) {
  if (value >= info.least && value <= info.largest) return;  // Never true of NaN.
  // Nobody needs the upper limit of an open range but who exceeds it.
  const bool is_huge = value > info.largest && info.largest >= kLargestSetting;
  throw Error(where, number_text(value) + " is out of range",
              "allowed is " + (is_huge ? "at most " + number_text(info.largest) : allowed_text(info)));
}

}  // namespace ldso
