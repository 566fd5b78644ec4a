#include "core/node_options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <utility>

#include "ldso/error.h"
#include "ldso/io/settings_file.h"
#include "ldso/settings.h"

namespace ldso::ros {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& value, const std::string& expected) {
  throw Error("parameter '" + name + "'", "its value '" + value + "' makes no sense", expected + " is expected");
}

double number_of(const std::string& name, const std::string& value) {
  double number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error != std::errc() || end != value.data() + value.size() || !(number >= 0) || !(number < 1e6))
    refuse(name, value, "a number from 0 on");
  return number;
}

int count_of(const std::string& name, const std::string& value) {
  const double number = number_of(name, value);
  if (number != static_cast<int>(number)) refuse(name, value, "a whole number from 0 on");
  return static_cast<int>(number);
}

bool truth_of(const std::string& name, const std::string& value) {
  if (value == "true" || value == "1") return true;
  if (value == "false" || value == "0") return false;
  refuse(name, value, "true or false");
}

struct OwnParameter {
  NodeParameter parameter;
  std::function<void(NodeOptions&, const std::string& name, const std::string& value)> set;
};

OwnParameter text(const char* name, std::string NodeOptions::*field, const char* description) {
  return {{name, NodeOptions().*field, description},
          [field](NodeOptions& options, const std::string&, const std::string& value) { options.*field = value; }};
}

OwnParameter truth(const char* name, bool NodeOptions::*field, const char* description) {
  return {{name, NodeOptions().*field ? "true" : "false", description},
          [field](NodeOptions& options, const std::string& own, const std::string& value) {
            options.*field = truth_of(own, value);
          }};
}

const std::vector<OwnParameter>& own_parameters() {
  static const std::vector<OwnParameter> all{
      text("image_topic", &NodeOptions::image_topic, "topic of the images"),
      text("image_transport", &NodeOptions::transport, "raw, compressed or another one of image_transport"),
      text("calibration", &NodeOptions::calibration, "file with the calibration, instead of camera_info"),
      text("results", &NodeOptions::results, "folder that is written at the end, as by `ldso run -o`"),
      text("map_frame", &NodeOptions::map_frame, "frame of poses and points"),
      text("camera_frame", &NodeOptions::camera_frame, "frame of the camera; empty: that of the images' headers"),
      {{"queue_size", std::to_string(NodeOptions().queue_size), "images that may wait; 0: all wait, none is dropped"},
       [](NodeOptions& options, const std::string& name, const std::string& value) {
         options.queue_size = count_of(name, value);
       }},
      {{"map_period", number_text(NodeOptions().map_period_s), "seconds from one path and cloud to the next"},
       [](NodeOptions& options, const std::string& name, const std::string& value) {
         options.map_period_s = number_of(name, value);
       }},
      truth("publish_tf", &NodeOptions::publish_tf, "the transformation from map_frame to camera_frame"),
      truth("rep103", &NodeOptions::rep103, "z of the map is up, x where the first camera looked"),
  };
  return all;
}

}  // namespace

std::vector<NodeParameter> node_parameters() {
  std::vector<NodeParameter> all;
  for (const OwnParameter& own : own_parameters()) all.push_back(own.parameter);
  for (const std::string& setting : setting_keys()) all.push_back({setting, "", ""});
  return all;
}

void set_parameter(NodeOptions& options, const std::string& name, const std::string& value) {
  const std::vector<OwnParameter>& own = own_parameters();
  const auto found =
      std::find_if(own.begin(), own.end(), [&](const OwnParameter& one) { return one.parameter.name == name; });
  if (found != own.end()) return found->set(options, name, value);
  Settings checked;
  set_setting(checked, name, value);
  options.settings.push_back(name + "=" + value);
}

std::string number_text(double number) {
  std::array<char, 32> text;
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() ? std::string(text.data(), end) : "0";
}

}  // namespace ldso::ros
