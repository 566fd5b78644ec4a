#include "core/node_options.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "ldso/error.h"

namespace ldso::ros {
namespace {

std::string error_of(const std::string& name, const std::string& value) {
  NodeOptions options;
  try {
    set_parameter(options, name, value);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(NodeOptions, DefaultsAreWhatTheyAreWithoutParameters) {
  NodeOptions options;
  for (const NodeParameter& parameter : node_parameters()) {
    if (!parameter.description.empty()) set_parameter(options, parameter.name, parameter.value);
  }
  const NodeOptions defaults;
  EXPECT_EQ(options.image_topic, defaults.image_topic);
  EXPECT_EQ(options.queue_size, defaults.queue_size);
  EXPECT_EQ(options.map_period_s, defaults.map_period_s);
  EXPECT_EQ(options.publish_tf, defaults.publish_tf);
  EXPECT_EQ(options.rep103, defaults.rep103);
  EXPECT_TRUE(options.settings.empty());
}

TEST(NodeOptions, ParametersAreSetByTheirNames) {
  NodeOptions options;
  set_parameter(options, "image_topic", "/cam");
  set_parameter(options, "image_transport", "compressed");
  set_parameter(options, "map_period", "2.5");
  set_parameter(options, "publish_tf", "false");
  set_parameter(options, "selection.candidates", "800");
  EXPECT_EQ(options.image_topic, "/cam");
  EXPECT_EQ(options.transport, "compressed");
  EXPECT_EQ(options.map_period_s, 2.5);
  EXPECT_FALSE(options.publish_tf);
  EXPECT_EQ(options.settings, std::vector<std::string>{"selection.candidates=800"});
}

TEST(NodeOptions, EverySettingIsAParameter) {
  const std::vector<NodeParameter> all = node_parameters();
  const auto is_there = [&](const std::string& name) {
    return std::any_of(all.begin(), all.end(), [&](const NodeParameter& parameter) { return parameter.name == name; });
  };
  EXPECT_TRUE(is_there("selection.candidates"));
  EXPECT_TRUE(is_there("loops.enabled"));
  EXPECT_TRUE(is_there("results"));
}

TEST(NodeOptions, WhatMakesNoSenseIsRefusedByName) {
  EXPECT_NE(error_of("queue_size", "-1").find("queue_size"), std::string::npos);
  EXPECT_NE(error_of("queue_size", "1.5").find("whole number"), std::string::npos);
  EXPECT_NE(error_of("map_period", "nan").find("map_period"), std::string::npos);
  EXPECT_NE(error_of("rep103", "maybe").find("true or false"), std::string::npos);
  EXPECT_NE(error_of("selection.candidates", "many").find("selection.candidates"), std::string::npos);
  EXPECT_NE(error_of("selection.candidate", "5").find("selection.candidates"), std::string::npos);
}

}  // namespace
}  // namespace ldso::ros
