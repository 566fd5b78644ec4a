#include "odometry/depth/window_tracer.h"

#include <vector>

#include "odometry/residual/photometric_residual.h"

namespace ldso {
namespace {

/// Points that a thread takes at once.
constexpr int kTracedAtOnce = 256;

}  // namespace

void WindowTracer::trace(Window& window, const PreparedFrame& frame, const SE3d& T_c_w, const Brightness& brightness,
                         const SE3d::Tangent& velocity) const {
  struct Job {
    ImmaturePoint* point;
    int host;
  };
  std::vector<Job> jobs;
  std::vector<PatternWarp> warps;
  for (auto& keyframe : window.keyframes) {
    const BrightnessTransfer transfer =
        brightness_transfer(keyframe->frame->exposure_ms, keyframe->state.brightness(), frame.exposure_ms, brightness);
    const SE3d T_frame_host = T_c_w * keyframe->state.T_c_w().inverse();
    warps.push_back(make_warp(T_frame_host, window.camera, transfer, frame.pyramid.levels.front()));
    add_readout(T_frame_host, window.camera, window.readout(*keyframe), window.readout_s * velocity, warps.back());
    for (ImmaturePoint& point : keyframe->immature) jobs.push_back({&point, keyframe->index});
  }
  pool_.for_chunks(static_cast<int>(jobs.size()), kTracedAtOnce, [&](int, int begin, int end) {
    for (int i = begin; i < end; ++i) tracer_.trace(*jobs[i].point, warps[jobs[i].host]);
  });
}

}  // namespace ldso
