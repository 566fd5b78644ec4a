#pragma once

// What a setting is: a member of a plain struct, whose initializer is the default, and beside it one line in the
// struct's fields() that says everything else. Files, command line, checks and documentation are made of these lines.
//
//     struct WindowSettings {
//       int iterations = 6;
//       static constexpr auto fields() {
//         return std::tuple{field("iterations", &WindowSettings::iterations, "Steps at most.", in_range(1, 100))};
//       }
//     };

#include <concepts>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

namespace ldso {

/// What is known of a setting or group beside its type and default.
struct SettingInfo {
  std::string_view name;
  std::string_view sentence;           ///< What it is, what it does.
  std::string_view unit = {};          ///< Empty: a count, a ratio, a word.
  double least = 0, largest = 0;       ///< Of a number.
  std::string_view source = "chosen";  ///< Of the default: a paper, "measured", or "chosen" by judgement.
  bool expert = false;                 ///< Rarely worth a change.
};

/// Beyond any use; keeps sums of squares of the settings finite.
inline constexpr double kLargestSetting = 1e15;

// The parts of a declaration after its sentence, in any order.

struct SettingRange {
  double least = 0, largest = 0;
  constexpr void add_to(SettingInfo& info) const { info.least = least, info.largest = largest; }
};
struct SettingUnit {
  std::string_view text;
  constexpr void add_to(SettingInfo& info) const { info.unit = text; }
};
struct SettingSource {
  std::string_view text;
  constexpr void add_to(SettingInfo& info) const { info.source = text; }
};
struct ExpertMark {
  constexpr void add_to(SettingInfo& info) const { info.expert = true; }
};

constexpr SettingRange in_range(double least, double largest) { return {least, largest}; }
constexpr SettingRange at_least(double least) { return {least, kLargestSetting}; }
constexpr SettingUnit in_unit(std::string_view text) { return {text}; }
/// The default is that of the paper.
constexpr SettingSource published_in(std::string_view paper) { return {paper}; }
/// The default was found by comparing results over sequences.
inline constexpr SettingSource kMeasured{"measured"};
inline constexpr ExpertMark kExpert;

/// A struct of settings.
template <class T>
concept SettingGroup = requires {
  T::fields();
};

/// A setting that is one of a few words: choices(T()) lists them as pairs of value and word.
template <class T>
concept SettingChoice = std::is_enum_v<T> && requires(T value) {
  choices(value);
};

/// A setting that has a range.
template <class T>
concept SettingNumber = std::is_arithmetic_v<T> && !std::same_as<T, bool>;

template <class Group, class Value>
struct Field {
  SettingInfo info;
  Value Group::*member;
};

template <class Group, class Value, class... Parts>
constexpr Field<Group, Value> field(std::string_view name, Value Group::*member, std::string_view sentence,
                                    Parts... parts) {
  static_assert(
      SettingGroup<Value> || SettingChoice<Value> || std::is_arithmetic_v<Value> || std::same_as<Value, std::string>,
      "a setting is a number, a switch, a text, a choice or a group");
  static_assert(SettingNumber<Value> == (std::same_as<Parts, SettingRange> || ...),
                "numbers and only they have a range");
  Field<Group, Value> result{{name, sentence}, member};
  (parts.add_to(result.info), ...);
  return result;
}

/// Calls visit(value, info) for each field of a group, in order; groups inside it are fields, too.
template <class Group, class Visitor>
void for_each_field(Group& group, Visitor&& visit) {
  std::apply([&](const auto&... fields) { (visit(group.*fields.member, fields.info), ...); },
             std::remove_const_t<Group>::fields());
}

/// Calls visit(key, value, info) for each setting below a group, in order; keys are dotted: "window.iterations". What
/// belongs to an expert group is expert itself.
template <class Group, class Visitor>
void for_each_setting(Group& group, Visitor&& visit, const std::string& prefix = "", bool expert = false) {
  for_each_field(group, [&](auto& value, SettingInfo info) {
    using Value = std::remove_cvref_t<decltype(value)>;
    const std::string key = prefix + std::string(info.name);
    info.expert = info.expert || expert;
    if constexpr (SettingGroup<Value>) {
      for_each_setting(value, visit, key + ".", info.expert);
    } else {
      visit(key, value, std::as_const(info));
    }
  });
}

/// The word of a choice.
template <SettingChoice Value>
constexpr std::string_view word_of(Value value) {
  for (const auto& [choice, word] : choices(value)) {
    if (choice == value) return word;
  }
  return "unknown";
}

}  // namespace ldso
