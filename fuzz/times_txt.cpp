// Times of images: TUM-mono's, KITTI's, and how they are joined with the names of images.

#include <vector>

#include "fuzz_target.h"
#include "io/datasets/frame_times.h"
#include "ldso/io/trajectory_file.h"

using namespace ldso;

LDSO_FUZZ_TARGET(times_txt) {
  const auto path = fuzz::scratch_file("times.txt", input);
  std::vector<std::string> warnings;
  for (const bool kitti : {false, true}) {
    const auto times =
        fuzz::accepted([&] { return kitti ? read_kitti_times(path, warnings) : read_tum_mono_times(path, warnings); });
    if (!times) continue;
    std::vector<std::string> names;
    for (const FrameTime& time : times->entries) {
      fuzz::expect(std::isfinite(time.timestamp), "a timestamp is finite");
      fuzz::expect(!time.exposure_ms || (std::isfinite(*time.exposure_ms) && *time.exposure_ms > 0),
                   "a known exposure is positive and finite");
      names.push_back(time.id + ".png");
    }
    names.emplace_back("image_7.png");
    for (int round = 0; round < 2; ++round, names.pop_back()) {
      const auto frames = fuzz::accepted([&] { return match_times(names, *times, warnings); });
      if (frames) fuzz::expect(frames->size() <= names.size(), "no image is used twice");
      if (names.empty()) break;
    }
  }
  if (const auto times = fuzz::accepted([&] { return read_times(path); })) {
    for (const double time : *times) fuzz::expect(std::isfinite(time), "a time is finite");
  }
}
