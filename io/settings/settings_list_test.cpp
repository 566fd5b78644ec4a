#include "io/settings/settings_list.h"

#include <gtest/gtest.h>

#include <string>

#include "ldso/io/settings_file.h"

namespace ldso {
namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(SettingsList, HasEverySettingInOrder) {
  std::vector<std::string> keys;
  for (const SettingRow& row : setting_rows()) {
    EXPECT_FALSE(row.sentence.empty()) << row.key;
    if (row.default_text.empty()) continue;
    EXPECT_FALSE(row.allowed.empty()) << row.key;
    EXPECT_FALSE(row.source.empty()) << row.key;
    keys.push_back(row.key);
  }
  EXPECT_EQ(keys, setting_keys());
}

TEST(SettingsList, TableHidesThoseForExperts) {
  const std::string usual = settings_table(false), all = settings_table(true);
  EXPECT_TRUE(contains(usual, "window.iterations"));
  EXPECT_TRUE(contains(usual, "whole, 1 to 100"));
  EXPECT_TRUE(contains(usual, "corners, gradient or random"));
  EXPECT_FALSE(contains(usual, "loops.graph"));
  EXPECT_FALSE(contains(usual, "\ntracing:"));  // All of its settings are for experts.
  EXPECT_TRUE(contains(all, "\ntracing:"));
  for (const std::string& key : setting_keys()) EXPECT_TRUE(contains(all, "  " + key + " ")) << key;
}

TEST(SettingsList, DefaultsAreThoseOfTheGroupInItsPlace) {
  const nlohmann::ordered_json json = settings_list_json(true);
  EXPECT_EQ(json["loops.similarity.max_iterations"]["default"], 10);
  EXPECT_EQ(json["loops.sharpening.similarity.max_iterations"]["default"], 5);
}

TEST(SettingsList, JsonTellsWhatIsDeclared) {
  const nlohmann::ordered_json json = settings_list_json(false);
  const nlohmann::ordered_json& drift = json["loops.max_drift"];
  EXPECT_EQ(drift["type"], "number");
  EXPECT_EQ(drift["default"], 0.15);
  EXPECT_EQ(drift["least"], 0);
  EXPECT_EQ(drift["largest"], 1000000);
  EXPECT_EQ(drift["expert"], false);
  EXPECT_EQ(json["selection.strategy"]["choices"].size(), 3u);
  EXPECT_EQ(json["loops.enabled"]["type"], "switch");
  EXPECT_FALSE(json.contains("loops.graph.kernel"));
  EXPECT_EQ(settings_list_json(true)["selection.corner_radius"]["unit"], "px");
  EXPECT_EQ(settings_list_json(true).size(), setting_keys().size());
}

TEST(SettingsList, MarkdownHasAllRowsAndMarksExperts) {
  const std::string text = settings_markdown();
  for (const std::string& key : setting_keys()) EXPECT_TRUE(contains(text, "| `" + key + "` |")) << key;
  EXPECT_TRUE(contains(text, "\n## loops.graph\n"));
  EXPECT_TRUE(contains(text, "*Expert.* |\n"));
}

}  // namespace
}  // namespace ldso
