#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/datasets/frame_times.h"
#include "io/images/image_source.h"
#include "ldso/io/dataset.h"

namespace ldso {

// What all formats of single images come down to once their files are read.

struct Sequence {
  std::string format_name;
  std::string location;  ///< For messages.
  std::unique_ptr<ImageSource> images;
  std::vector<FrameEntry> frames;
  /// A camera size of 0x0 is filled in from the first readable image.
  Calibration calibration;
  std::optional<Trajectory> ground_truth;
  std::vector<std::string> warnings;
  /// That are used of images of 16 bits; found out when the data set is made.
  int bits = 16;
};

/// Throws Error if there is no frame, no frame can be read, or the images are not of the calibration's size.
std::unique_ptr<Dataset> make_sequence_dataset(Sequence sequence);

/// Sets the ground truth to what `read` returns; what it throws becomes a warning, since a sequence can be run without.
void read_ground_truth(Sequence& sequence, const std::function<Trajectory()>& read);

}  // namespace ldso
