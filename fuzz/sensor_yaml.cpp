// EuRoC's sensor.yaml.

#include "fuzz_target.h"
#include "io/datasets/euroc_camera.h"

using namespace ldso;

LDSO_FUZZ_TARGET(sensor_yaml) {
  const auto camera = fuzz::accepted([&] { return read_euroc_camera(fuzz::scratch_file("sensor.yaml", input)); });
  if (!camera) return;
  const CameraCalibration& c = camera->calibration.camera;
  fuzz::expect(c.width > 0 && c.height > 0 && c.fx > 0 && c.fy > 0, "sizes and focal lengths are positive");
  fuzz::expect(
      fuzz::all_finite({c.fx, c.fy, c.cx, c.cy, c.distortion[0], c.distortion[1], c.distortion[2], c.distortion[3]}),
      "all numbers of a calibration are finite");
  fuzz::expect(camera->T_body_camera.matrix().allFinite(), "where the camera sits is finite");
}
