#include "ros1/test/sequence_reader.h"

#include <cmath>

#include "ldso/error.h"
#include "ldso/io/dataset.h"

namespace ldso::ros {

struct SequenceReader::Impl {
  std::unique_ptr<Dataset> dataset;
};

SequenceReader::SequenceReader(const std::string& folder)
    : impl_(std::make_unique<Impl>(Impl{open_dataset(folder)})) {
  const CameraModelKind model = impl_->dataset->calibration().camera.model;
  if (model != CameraModelKind::kRadTan && model != CameraModelKind::kPinhole)
    throw Error(folder, "its camera is of a model that camera_info does not have", "take RadTan");
}

SequenceReader::~SequenceReader() = default;

int SequenceReader::size() const { return impl_->dataset->size(); }

RosCameraInfo SequenceReader::camera() const {
  const CameraCalibration& camera = impl_->dataset->calibration().camera;
  RosCameraInfo info;
  info.width = static_cast<std::uint32_t>(camera.width);
  info.height = static_cast<std::uint32_t>(camera.height);
  info.model = "plumb_bob";
  info.distortion.assign(camera.distortion.begin(), camera.distortion.end());
  info.distortion.push_back(camera.more_distortion[0]);
  info.K = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  return info;
}

SequenceReader::Frame SequenceReader::read(int index) const {
  const RawFrame raw = impl_->dataset->read(index);
  Frame frame;
  frame.timestamp = raw.timestamp;
  frame.width = static_cast<std::uint32_t>(raw.grey.width());
  frame.height = static_cast<std::uint32_t>(raw.grey.height());
  for (std::size_t i = 0; i < raw.grey.size(); ++i)
    frame.grey.push_back(static_cast<std::uint8_t>(std::lround(raw.grey.data()[i])));
  return frame;
}

}  // namespace ldso::ros
