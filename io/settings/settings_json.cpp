#include "io/settings/settings_json.h"

#include <string>
#include <type_traits>

namespace ldso {
namespace {

template <class Group>
nlohmann::json group_to_json(const Group& group) {
  nlohmann::json json = nlohmann::json::object();
  for_each_field(group, [&](const auto& value, const SettingInfo& info) {
    using Value = std::remove_cvref_t<decltype(value)>;
    nlohmann::json& member = json[std::string(info.name)];
    if constexpr (SettingGroup<Value>) {
      member = group_to_json(value);
    } else if constexpr (SettingChoice<Value>) {
      member = std::string(word_of(value));
    } else {
      member = value;
    }
  });
  return json;
}

}  // namespace

nlohmann::json settings_to_json(const Settings& settings) { return group_to_json(settings); }

}  // namespace ldso
