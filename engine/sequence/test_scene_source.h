#pragma once

// The drawn scene as a sequence; some frames may be bad.

#include <algorithm>
#include <new>
#include <string>

#include "ldso/error.h"
#include "ldso/frame_source.h"
#include "slam/test_scene.h"

namespace ldso {

class SceneSource final : public FrameSource {
 public:
  /// `step`: time between two frames [s].
  explicit SceneSource(int size, double step = 0.1) : size_(size), step_(step), calibration_(scene_calibration()) {}

  int unreadable = -1;
  int wrong_size = -1;
  int without_memory = -1;

  int size() const override { return size_; }
  double timestamp(int index) const override { return step_ * index; }
  const Calibration& calibration() const override { return calibration_; }

  RawFrame read(int index) const override {
    if (index == unreadable) throw Error("image " + std::to_string(index), "cannot be decoded", "replace it");
    if (index == without_memory) throw std::bad_alloc();
    RawFrame raw;
    raw.id = index;
    raw.timestamp = timestamp(index);
    raw.name = "image " + std::to_string(index);
    raw.grey = Image<float>(kSceneWidth, kSceneHeight);
    const Image<std::uint8_t> drawn = draw_scene(index);
    std::copy_n(drawn.data(), drawn.size(), raw.grey.data());
    if (index == wrong_size) raw.grey = Image<float>(64, 48);
    return raw;
  }

 private:
  int size_;
  double step_;
  Calibration calibration_;
};

}  // namespace ldso
