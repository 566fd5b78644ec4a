#include "ldso/settings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <tuple>
#include <type_traits>

#include "ldso/error.h"
#include "settings/setting_range.h"

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

/// Calls act(key, number, info) for each number.
template <class Act>
void for_numbers(Settings& settings, Act act) {
  for_each_setting(settings, [&](const std::string& key, auto& value, const SettingInfo& info) {
    if constexpr (SettingNumber<std::remove_cvref_t<decltype(value)>>) act(key, value, info);
  });
}

/// Converts to every member of a struct.
struct Anything {
  template <class T>
  operator T() const;  // NOLINT(google-explicit-constructor)
};

template <class T, class... Members>
constexpr std::size_t member_count() {
  if constexpr (requires { T{Members{}..., Anything{}}; }) {
    return member_count<T, Members..., Anything>();
  } else {
    return sizeof...(Members);
  }
}

/// Compares the number of members with that of fields, in the group and those inside it.
template <class T>
void expect_all_declared(const T& group, const std::string& name) {
  EXPECT_EQ(member_count<T>(), std::tuple_size_v<decltype(T::fields())>) << name;
  for_each_field(group, [](const auto& value, const SettingInfo& info) {
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (SettingGroup<Value>) expect_all_declared(value, std::string(info.name));
  });
}

TEST(Settings, DefaultsAreValid) { EXPECT_EQ(complaint(Settings{}), ""); }

TEST(Settings, EveryMemberIsDeclared) { expect_all_declared(Settings{}, "settings"); }

TEST(Settings, EachHasASentenceANameAndAMemberOfItsOwn) {
  const Settings settings;
  std::set<std::string> keys;
  std::set<const void*> members;
  for_each_setting(settings, [&](const std::string& key, const auto& value, const SettingInfo& info) {
    EXPECT_TRUE(keys.insert(key).second) << key;
    EXPECT_TRUE(members.insert(&value).second) << key;
    ASSERT_FALSE(info.sentence.empty()) << key;
    EXPECT_EQ(info.sentence.back(), '.') << key;
    EXPECT_EQ(key.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_."), std::string::npos) << key;
  });
  EXPECT_GT(keys.size(), 100u);
}

TEST(Settings, ExpertGroupsMakeTheirSettingsExpert) {
  const Settings settings;
  std::set<std::string> usual;
  for_each_setting(settings, [&](const std::string& key, const auto&, const SettingInfo& info) {
    if (!info.expert) usual.insert(key);
  });
  EXPECT_TRUE(usual.contains("loops.max_drift"));
  EXPECT_FALSE(usual.contains("loops.graph.kernel"));
  EXPECT_FALSE(usual.contains("loops.sharpening.alignment.max_gain"));
  EXPECT_LT(usual.size(), 40u);
}

TEST(Settings, EveryNumberIsHeldToItsRange) {
  Settings settings;
  for_numbers(settings, [&](const std::string& key, auto& field, const SettingInfo& info) {
    using Value = std::remove_reference_t<decltype(field)>;
    ASSERT_LT(info.least, info.largest) << key;
    const Value before = field;
    field = static_cast<Value>(info.least - 1);
    EXPECT_NE(complaint(settings).find("setting " + key + ": "), std::string::npos) << key;
    if (info.largest < std::numeric_limits<int>::max()) {
      field = static_cast<Value>(info.largest + 1);
      EXPECT_NE(complaint(settings).find("setting " + key + ": "), std::string::npos) << key;
    }
    field = before;
    EXPECT_EQ(complaint(settings), "") << key;
  });
}

TEST(Settings, ComplaintsNameSettingValueRangeAndUnit) {
  Settings settings;
  settings.tracking.least_in_view = 1.5;
  EXPECT_EQ(complaint(settings), "setting tracking.least_in_view: 1.5 is out of range; allowed is 0 to 1");
  settings = {};
  settings.selection.corner_radius = 0;
  EXPECT_EQ(complaint(settings), "setting selection.corner_radius: 0 is out of range; allowed is 1 to 100 px");
  settings = {};
  settings.loops.graph.chi2 = -1;
  EXPECT_EQ(complaint(settings), "setting loops.graph.chi2: -1 is out of range; allowed is at least 0");
  settings.loops.graph.chi2 = 1e16;
  EXPECT_EQ(complaint(settings), "setting loops.graph.chi2: 1e+16 is out of range; allowed is at most 1e+15");
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

TEST(Settings, ChoicesHaveWords) {
  EXPECT_EQ(word_of(SelectionStrategy::kGradient), "gradient");
  EXPECT_EQ(choices(SelectionStrategy()).size(), 3u);
}

}  // namespace
}  // namespace ldso
