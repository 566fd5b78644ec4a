#include "ldso/io/settings_file.h"
#include "io/settings/settings_json.h"

#include <gtest/gtest.h>

#include <concepts>
#include <string>
#include <type_traits>

#include "io/datasets/test_sequences.h"
#include "io/settings/setting_text.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

class SettingsFile : public testing::Test {
 protected:
  Settings read(const std::string& text) const {
    write_text(folder_ / "s.yaml", text);
    Settings settings;
    read_settings(folder_ / "s.yaml", settings);
    return settings;
  }
  std::string error(const std::string& text) const {
    return error_of([&] { read(text); });
  }

  TemporaryFolder folder_;
};

TEST_F(SettingsFile, ChangesWhatItNamesOnly) {
  const Settings settings = read(
      "threads: 3\nselection:\n  strategy: Gradient\n  candidates: 900\nphotometry: {prior_b: 1e3, use_vignette: "
      "false}\n");
  EXPECT_EQ(settings.threads, 3);
  EXPECT_EQ(settings.selection.strategy, SelectionStrategy::kGradient);
  EXPECT_EQ(settings.selection.candidates, 900);
  EXPECT_EQ(settings.selection.corner_radius, Settings().selection.corner_radius);
  EXPECT_EQ(settings.photometry.prior_b, 1000);
  EXPECT_FALSE(settings.photometry.use_vignette);
}

TEST_F(SettingsFile, APresetCountsBeforeTheRest) {
  const Settings settings = read("window: {iterations: 9}\npreset: fast\n");
  EXPECT_EQ(settings.longest_side, 424);
  EXPECT_EQ(settings.selection.candidates, 800);
  EXPECT_EQ(settings.window.iterations, 9);
  EXPECT_EQ(settings_to_json(read("preset: default\n")), settings_to_json({}));
  EXPECT_NE(
      error("threads: 1\npreset: faster\n").find("s.yaml:2: there is no preset 'faster'; there are: default, fast"),
      std::string::npos)
      << error("threads: 1\npreset: faster\n");
  EXPECT_NE(error("preset: [fast]\n").find("has no single value"), std::string::npos);
}

TEST_F(SettingsFile, PresetsAreSettingsOfTheCommandLine) {
  Settings settings;
  set_setting(settings, "preset", "fast");
  EXPECT_EQ(settings.window.active_points, 800);
  set_setting(settings, "window.active_points", "900");
  EXPECT_EQ(settings.window.active_points, 900);
  EXPECT_THROW(set_setting(settings, "preset", "slow"), Error);
}

TEST_F(SettingsFile, EmptyFileChangesNothing) {
  EXPECT_EQ(settings_to_json(read("# nothing\n")), settings_to_json({}));
}

TEST_F(SettingsFile, UnknownKeysNameFileLineAndTheNearestKey) {
  EXPECT_NE(error("threads: 2\nselection:\n  candidate: 5\n")
                .find("s.yaml:3: unknown setting 'selection.candidate'; did you mean 'selection.candidates'?"),
            std::string::npos);
  EXPECT_NE(error("thread: 2\n").find("s.yaml:1: unknown setting 'thread'; did you mean 'threads'?"),
            std::string::npos);
  EXPECT_NE(
      error("\niterations: 3\n").find("s.yaml:2: unknown setting 'iterations'; did you mean 'window.iterations'?"),
      std::string::npos);
  EXPECT_NE(error("loops: {graph: {kernl: 3}}\n").find("did you mean 'loops.graph.kernel'?"), std::string::npos);
  EXPECT_NE(error("loops: {grahp: {kernel: 3}}\n").find("did you mean 'loops.graph'?"), std::string::npos);
}

TEST_F(SettingsFile, BadValuesNameFileLineAndKey) {
  const std::pair<const char*, const char*> cases[] = {
      {"\nthreads: two\n", "s.yaml:2: threads: 'two' is not valid; a whole number is expected"},
      {"threads: 2.5\n", "a whole number is expected"},
      {"threads: 99999999999\n", "a whole number is expected"},
      {"selection: {corner_quality: nan}\n", "a finite number is expected"},
      {"selection: {strategy: corner}\n", "corners, gradient or random is expected"},
      {"photometry: {use_response: maybe}\n", "true or false is expected"},
      {"threads: [1, 2]\n", "'threads' has no single value"},
      {"threads:\n", "'threads' has no single value"},
      {"selection: 3\n", "is not a group"},
      {"- 1\n", "is not a group"},
      {"threads: 1\nthreads: 2\n", "s.yaml:2: 'threads' is set twice"},
      {"threads: [1\n", "s.yaml:"},
  };
  for (const auto& [text, complaint] : cases) {
    EXPECT_NE(error(text).find(complaint), std::string::npos) << text << "-> " << error(text);
  }
}

TEST_F(SettingsFile, ValuesOutOfRangeNameFileLineRangeAndUnit) {
  EXPECT_EQ(error("threads: 1\nselection:\n  corner_radius: 0\n"),
            (folder_ / "s.yaml").string() + ":3: selection.corner_radius: 0 is out of range; allowed is 1 to 100 px");
  EXPECT_NE(error("window: {focal_prior: -1}\n").find("allowed is at least 0 1 / px^2"), std::string::npos);
  Settings settings;
  EXPECT_EQ(error_of([&] { set_setting(settings, "selection.corner_radius", "101"); }),
            "setting selection.corner_radius: 101 is out of range; allowed is 1 to 100 px");
  EXPECT_EQ(settings.selection.corner_radius, Settings().selection.corner_radius);
}

TEST_F(SettingsFile, ABadFileChangesNothing) {
  write_text(folder_ / "s.yaml", "threads: 7\nbad: 1\n");
  Settings settings;
  error_of([&] { read_settings(folder_ / "s.yaml", settings); });
  EXPECT_EQ(settings.threads, Settings().threads);
}

TEST_F(SettingsFile, IsReadAsWritten) {
  Settings settings;
  settings.selection.strategy = SelectionStrategy::kRandom;
  settings.selection.corner_quality = 0.1 + 0.2;
  settings.photometry.prior_a = 1e-300;
  settings.photometry.use_exposure = false;
  write_settings(folder_ / "s.yaml", settings);
  EXPECT_EQ(settings_to_json(read(read_file(folder_ / "s.yaml"))), settings_to_json(settings));
}

TEST_F(SettingsFile, EveryFieldCanBeSetByItsKey) {
  const nlohmann::json defaults = settings_to_json({});
  const Settings before;
  int count = 0;
  for_each_setting(before, [&](const std::string& key, const auto& value, const SettingInfo& info) {
    using Value = std::remove_cvref_t<decltype(value)>;
    std::string other = "random";  // A choice or a text.
    if constexpr (std::same_as<Value, bool>) other = value ? "false" : "true";
    if constexpr (SettingNumber<Value>) {
      other = setting_text(static_cast<Value>(static_cast<double>(value) == info.least ? info.least + 1 : info.least));
    }
    Settings settings;
    set_setting(settings, key, other);
    EXPECT_NE(settings_to_json(settings), defaults) << key;
    ++count;
  });
  EXPECT_EQ(setting_keys().size(), static_cast<std::size_t>(count));
}

TEST_F(SettingsFile, BadKeysOnTheCommandLineAreErrors) {
  Settings s;
  EXPECT_NE(error_of([&] { set_setting(s, "selection.sed", "1"); }).find("did you mean 'selection.seed'?"),
            std::string::npos);
  EXPECT_NE(error_of([&] { set_setting(s, "selektion.seed", "1"); }).find("did you mean 'selection.seed'?"),
            std::string::npos);
  EXPECT_NE(error_of([&] { set_setting(s, "selection", "1"); }).find("is a group"), std::string::npos);
  EXPECT_NE(error_of([&] { set_setting(s, "threads.x", "1"); }).find("no group"), std::string::npos);
  EXPECT_NE(error_of([&] { set_setting(s, "selection.seed", "1x"); }).find("selection.seed: '1x'"), std::string::npos);
}

TEST_F(SettingsFile, JsonHasTheGroups) {
  const nlohmann::json json = settings_to_json({});
  EXPECT_EQ(json["selection"]["candidates"], 1500);
  EXPECT_EQ(json["selection"]["strategy"], "corners");
  EXPECT_EQ(json["photometry"]["use_response"], true);
  EXPECT_EQ(json["loops"]["sharpening"]["similarity"]["max_iterations"], 5);
}

TEST_F(SettingsFile, NamesOfFilesMayBeAnyBytes) {
  Settings s;
  set_setting(s, "loops.vocabulary", "b\xe4r.ldsovoc");
  EXPECT_EQ(s.loops.vocabulary, "b\xe4r.ldsovoc");
  write_settings(folder_ / "written.yaml", s);  // Does not fail, though YAML cannot hold it.
  EXPECT_NE(read_file(folder_ / "written.yaml").find("b\xef\xbf\xbdr.ldsovoc"), std::string::npos);
}

}  // namespace
}  // namespace ldso
