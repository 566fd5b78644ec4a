// run.json and checkpoint.json, as `ldso export` and `ldso resume` read them.

#include "output/finished_run.h"

#include "fuzz_target.h"
#include "output/checkpoint_file.h"

using namespace ldso;

LDSO_FUZZ_TARGET(finished_run) {
  fuzz::accepted([&] { return describe_checkpoint(std::string(input), "checkpoint.json"); });
  fuzz::scratch_file("run.json", input);
  const auto run = fuzz::accepted([&] { return read_finished_run(fuzz::scratch_folder()); });
  if (!run) return;
  const PinholeIntrinsics& c = run->camera;
  fuzz::expect(fuzz::all_finite({c.fx, c.fy, c.cx, c.cy}), "the camera of a run is finite");
  fuzz::expect(!run->options.fps || std::isfinite(*run->options.fps), "a frame rate is finite");
}
