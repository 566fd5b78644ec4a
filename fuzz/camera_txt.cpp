// camera.txt, all models.

#include <tuple>

#include "fuzz_target.h"
#include "ldso/io/calibration_file.h"

using namespace ldso;

namespace {

auto numbers_of(const CameraCalibration& c) {
  return std::tuple(c.model, c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.distortion, c.more_distortion, c.readout_ms);
}

auto numbers_of(const Rectification& r) {
  const PinholeIntrinsics& e = r.explicit_intrinsics;
  return std::tuple(r.mode, r.width, r.height, e.width, e.height, e.fx, e.fy, e.cx, e.cy);
}

}  // namespace

LDSO_FUZZ_TARGET(camera_txt) {
  const auto read = fuzz::accepted([&] { return read_camera_calibration(fuzz::scratch_file("camera.txt", input)); });
  if (!read) return;
  const CameraCalibration& c = read->camera;
  const PinholeIntrinsics& e = read->rectification.explicit_intrinsics;
  fuzz::expect(c.width > 0 && c.height > 0 && c.fx > 0 && c.fy > 0, "sizes and focal lengths are positive");
  fuzz::expect(fuzz::all_finite({c.fx, c.fy, c.cx, c.cy, c.readout_ms, e.fx, e.fy, e.cx, e.cy, c.distortion[0],
                                 c.distortion[1], c.distortion[2], c.distortion[3], c.more_distortion[0]}),
               "all numbers of a calibration are finite");
  const Calibration again = read_camera_calibration(fuzz::scratch_file("again.txt", camera_file_text(*read)));
  fuzz::expect(numbers_of(again.camera) == numbers_of(c), "a written camera reads back as it was");
  fuzz::expect(numbers_of(again.rectification) == numbers_of(read->rectification), "its rectification as well");
}
