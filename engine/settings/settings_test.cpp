#include "ldso/settings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include "ldso/error.h"
#include "settings/settings_ranges.h"

namespace ldso {
namespace {

std::string complaint(const Settings& settings) {
  try {
    settings.validate();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Calls act(key, field) for each number.
template <class Act>
struct ForNumbers {
  std::string prefix;
  Act& act;

  template <class Value>
  void operator()(const char* name, Value& value) const {
    if constexpr (std::is_same_v<Value, bool> || std::is_same_v<Value, std::string> || std::is_enum_v<Value>) {
      return;
    } else if constexpr (std::is_arithmetic_v<Value>) {
      act(prefix + name, value);
    } else {
      Value::visit_fields(value, ForNumbers{prefix + name + ".", act});
    }
  }
};

template <class Act>
void for_numbers(Settings& settings, Act act) {
  Settings::visit_fields(settings, ForNumbers<Act>{"", act});
}

TEST(Settings, DefaultsAreValid) { EXPECT_EQ(complaint(Settings{}), ""); }

TEST(Settings, EveryNumberHasARange) {
  Settings settings;
  int count = 0;
  for_numbers(settings, [&](const std::string& key, auto&) {
    EXPECT_TRUE(setting_range(key).has_value()) << key << " is missing in settings.cpp";
    ++count;
  });
  EXPECT_GT(count, 30);
}

TEST(Settings, EveryNumberIsHeldToItsRange) {
  Settings settings;
  for_numbers(settings, [&](const std::string& key, auto& field) {
    using Value = std::remove_reference_t<decltype(field)>;
    const auto range = setting_range(key);
    if (!range) return;
    const Value before = field;
    field = static_cast<Value>(range->least - 1);
    EXPECT_NE(complaint(settings).find("setting " + key + ": "), std::string::npos) << key;
    if (range->largest < std::numeric_limits<int>::max()) {
      field = static_cast<Value>(range->largest + 1);
      EXPECT_NE(complaint(settings).find("setting " + key + ": "), std::string::npos) << key;
    }
    field = before;
    EXPECT_EQ(complaint(settings), "") << key;
  });
}

TEST(Settings, NamesFieldValueAndRange) {
  Settings settings;
  settings.tracking.least_in_view = 1.5;
  EXPECT_EQ(complaint(settings), "setting tracking.least_in_view: 1.5 is out of range; allowed is 0 to 1");
}

TEST(Settings, RejectsWhatIsNoNumber) {
  Settings settings;
  settings.window.focal_prior = std::nan("");
  EXPECT_NE(complaint(settings).find("window.focal_prior"), std::string::npos);
}

TEST(Settings, SmallestWindowMustNotExceedTheLargest) {
  Settings settings;
  settings.keyframes.window_min = 8;
  settings.keyframes.window_max = 6;
  EXPECT_NE(complaint(settings).find("at most keyframes.window_max, 6"), std::string::npos);
}

}  // namespace
}  // namespace ldso
