#pragma once
// Frames of a sequence, looked at: many at its beginning, some all over it.

#include <functional>
#include <string>
#include <vector>

#include "doctor/frame_facts.h"
#include "doctor/still_picture.h"
#include "ldso/io/dataset.h"

namespace ldso {

struct ImageSurvey {
  int width = 0, height = 0;
  std::vector<FrameFacts> frames;
  std::vector<PairFacts> pairs;  ///< Of frames that follow each other in the sequence.
  StillPicture still;
  int exposures_known = 0;  ///< Frames that say their exposure.
  int unreadable = 0;
  std::string first_problem;  ///< Of an unreadable one.
};

/// Indices of the frames that are looked at, growing: stretches of frames that follow each other.
std::vector<int> surveyed_frames(int size);

/// Reads them. Frames that cannot be read or have another size than most are counted. `progress` hears after each how
/// many of how many are done.
ImageSurvey survey_images(const Dataset& dataset, const std::function<void(int, int)>& progress = {});

}  // namespace ldso
