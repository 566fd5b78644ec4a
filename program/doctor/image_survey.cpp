#include "doctor/image_survey.h"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "ldso/error.h"

namespace ldso {
namespace {

/// Frames at the beginning, and stretches all over the sequence.
constexpr int kFirst = 90;
constexpr int kStretches = 40;
constexpr int kStretchLength = 4;

/// Beginning with the first frame, each of so many is taken for what stays in the image.
constexpr int kStillEvery = 30;

std::optional<RawFrame> read_frame(const Dataset& dataset, int index, ImageSurvey& survey) {
  try {
    RawFrame frame = dataset.read(index);
    const CameraCalibration& camera = dataset.calibration().camera;
    if (frame.grey.width() == camera.width && frame.grey.height() == camera.height) return frame;
    throw Error(frame.name, "has another size than the calibration says", "");
  } catch (const Error& error) {
    if (survey.unreadable++ == 0) survey.first_problem = error.what();
    return std::nullopt;
  }
}

}  // namespace

std::vector<int> surveyed_frames(int size) {
  std::vector<int> indices;
  for (int i = 0; i < std::min(size, kFirst); ++i) indices.push_back(i);
  for (int k = 0; k < kStretches; ++k) {
    const int begin = static_cast<int>(static_cast<double>(size) * k / kStretches);
    for (int i = begin; i < std::min(size, begin + kStretchLength); ++i) indices.push_back(i);
  }
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  return indices;
}

ImageSurvey survey_images(const Dataset& dataset, const std::function<void(int, int)>& progress) {
  ImageSurvey survey;
  survey.width = dataset.calibration().camera.width;
  survey.height = dataset.calibration().camera.height;
  const std::vector<int> indices = surveyed_frames(dataset.size());
  std::optional<RawFrame> before;
  int last_still = -kStillEvery;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    std::optional<RawFrame> frame = read_frame(dataset, indices[i], survey);
    if (frame) {
      survey.frames.push_back(measure_frame(frame->grey.view()));
      survey.frames.back().index = indices[i];
      if (frame->exposure_ms) ++survey.exposures_known;
      if (indices[i] >= last_still + std::min(kStillEvery, std::max(1, dataset.size() / kStretches))) {
        survey.still.add(frame->grey.view());
        last_still = indices[i];
      }
    }
    if (frame && before && i > 0 && indices[i] == indices[i - 1] + 1) {
      survey.pairs.push_back(measure_pair(before->grey.view(), frame->grey.view()));
      survey.pairs.back().index = indices[i];
    }
    before = std::move(frame);
    if (progress) progress(static_cast<int>(i) + 1, static_cast<int>(indices.size()));
  }
  return survey;
}

}  // namespace ldso
