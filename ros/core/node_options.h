#pragma once

#include <string>
#include <vector>

namespace ldso::ros {

/// What a node is told by parameters.
struct NodeOptions {
  std::string image_topic = "image";
  std::string transport = "raw";     ///< "raw", "compressed" or another one of image_transport.
  std::string calibration;           ///< File, as of `ldso run --calib`, instead of camera_info; empty: none.
  std::string results;               ///< Folder that is written at the end, as by `ldso run -o`; empty: none.
  std::string map_frame = "map";     ///< Of poses and points.
  std::string camera_frame;          ///< Of the camera; empty: that of the images' headers.
  int queue_size = 4;                ///< Images that may wait; 0: all wait and none is dropped.
  double map_period_s = 1;           ///< From one path and cloud to the next, by the images' times.
  bool publish_tf = true;            ///< map_frame to camera_frame.
  bool rep103 = true;                ///< z of the map is up, x where the first camera looked.
  std::vector<std::string> settings; ///< "selection.candidates=800"
};

/// A parameter of the node, or a setting, which is one as well.
struct NodeParameter {
  std::string name;   ///< Of settings with dots: "selection.candidates".
  std::string value;  ///< By default.
  std::string description;
};

/// All of them: those of the node first, then the settings, which have no description here (see `ldso settings`).
std::vector<NodeParameter> node_parameters();

/// Sets the one of that name. Throws Error naming it if it is unknown or the value makes no sense.
void set_parameter(NodeOptions& options, const std::string& name, const std::string& value);

/// A number as text that set_parameter() reads, whatever the locale.
std::string number_text(double number);

}  // namespace ldso::ros
