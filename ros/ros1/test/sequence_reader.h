#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ldso/io/ros_types.h"

namespace ldso::ros {

/// A sequence on disk in plain types: messages of ROS 1 are C++17, the library is C++20.
class SequenceReader {
 public:
  struct Frame {
    double timestamp = 0;  ///< [s]
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> grey;
  };

  /// Throws Error; also if camera_info has no such camera.
  explicit SequenceReader(const std::string& folder);
  ~SequenceReader();

  int size() const;
  RosCameraInfo camera() const;
  Frame read(int index) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ldso::ros
