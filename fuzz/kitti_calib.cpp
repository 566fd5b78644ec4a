// KITTI's calib.txt.

#include "fuzz_target.h"
#include "ldso/io/calibration_file.h"

LDSO_FUZZ_TARGET(kitti_calib) {
  const auto matrices =
      ldso::fuzz::accepted([&] { return ldso::read_kitti_calibration(ldso::fuzz::scratch_file("calib.txt", input)); });
  if (!matrices) return;
  ldso::fuzz::expect(!matrices->empty(), "a calibration has a matrix");
  for (const auto& [name, P] : *matrices) {
    ldso::fuzz::expect(P.allFinite() && P(0, 0) > 0 && P(1, 1) > 0,
                       "a projection is finite, its focal lengths positive");
  }
}
