// Videos, as far as they are ours: the codecs are FFmpeg's.

#include "fuzz_target.h"
#include "io/datasets/video_dataset.h"

using namespace ldso;

LDSO_FUZZ_TARGET(video) {
  const auto path = fuzz::scratch_file("video.avi", input);
  DatasetOptions options;
  options.calibration_file = fuzz::scratch_file("camera.txt", "Pinhole 40 41 15.5 11.5 0\n32 24\nnone\n32 24\n");
  fuzz::accepted([&] {
    const auto video = open_video(path, options);
    fuzz::expect(video->size() > 0 && std::isfinite(video->timestamp(0)), "a video has frames and times");
    for (const int index : {0, std::min(5, video->size() - 1), 2})
      fuzz::accepted([&] { return index < video->size() && video->read(index).grey.width() > 0; });
    return true;
  });
}
