// Calibrations that other programs wrote: the input is read by its content, and as YAML.

#include "io/calibration/foreign_calibration.h"
#include "fuzz_target.h"
#include "geometry/camera_model.h"

using namespace ldso;

LDSO_FUZZ_TARGET(foreign_calibration) {
  for (const char* name : {"calibration.txt", "calibration.yaml"}) {
    const auto path = fuzz::scratch_file(name, input);
    const auto read = fuzz::accepted([&] { return read_foreign_calibration(path); });
    if (!read || !*read) continue;
    const CameraCalibration& c = (*read)->camera;
    fuzz::expect(c.width > 0 && c.height > 0 && c.fx > 0 && c.fy > 0, "sizes and focal lengths are positive");
    fuzz::expect(fuzz::all_finite({c.fx, c.fy, c.cx, c.cy}), "intrinsics are finite");
    for (int i = 0; i < 4; ++i)
      fuzz::expect(fuzz::all_finite({c.distortion[i], c.more_distortion[i]}), "so is the lens");
    const auto ray = make_camera_model(c)->unproject({c.cx, c.cy});
    if (ray) fuzz::expect(ray->allFinite(), "a ray is finite");
  }
}
