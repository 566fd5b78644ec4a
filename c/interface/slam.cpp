// Images one by one.

#include <memory>
#include <optional>
#include <string>

#include "interface/guard.h"
#include "interface/pose.h"

using ldso::c::guarded;
using ldso::c::require;

struct ldso_slam {
  ldso::Slam slam;
  ldso::FrameRecord newest;
};

namespace {

ldso::LogSink to_sink(ldso_log log, void* user) {
  if (log == nullptr) return {};
  return [log, user](ldso::LogLevel level, const std::string& text) {
    log(user, level == ldso::LogLevel::kWarning ? 1 : 0, text.c_str());
  };
}

ldso_state to_state(ldso::TrackingState state) {
  if (state == ldso::TrackingState::kInitializing) return LDSO_INITIALIZING;
  return state == ldso::TrackingState::kTracked ? LDSO_TRACKED : LDSO_LOST;
}

template <class T>
ldso_status process(ldso_slam* slam, const ldso::ImageView<const T>& image, double timestamp, double exposure_ms,
                    ldso_frame* frame) {
  return guarded(LDSO_ERROR, [&] {
    require(slam, "slam");
    slam->newest = slam->slam.process(image, timestamp, exposure_ms);
    const ldso::FrameRecord& record = slam->newest;
    if (frame != nullptr)
      *frame = {record.frame_id,     record.keyframe_id, to_state(record.state), record.is_keyframe ? 1 : 0,
                record.residual_rmse, 0};
    return LDSO_OK;
  });
}

ldso_result* to_result(ldso::SlamResult&& result) {
  auto made = std::make_unique<ldso_result>();
  made->result = std::move(result);
  made->poses = made->result.trajectory();
  made->points = made->result.points();
  return made.release();
}

}  // namespace

extern "C" {

ldso_slam* ldso_slam_new(const ldso_calibration* calibration, const ldso_settings* settings, ldso_log log, void* user) {
  return guarded<ldso_slam*>(nullptr, [&] {
    require(calibration, "calibration");
    const ldso::Settings used = settings != nullptr ? settings->settings : ldso::Settings{};
    return std::make_unique<ldso_slam>(ldso_slam{ldso::Slam(calibration->calibration, used, to_sink(log, user)), {}})
        .release();
  });
}

ldso_status ldso_slam_process_u8(ldso_slam* slam, const uint8_t* pixels, int width, int height, ptrdiff_t stride,
                                 double timestamp, double exposure_ms, ldso_frame* frame) {
  return process<std::uint8_t>(slam, {pixels, width, height, stride}, timestamp, exposure_ms, frame);
}

ldso_status ldso_slam_process_u16(ldso_slam* slam, const uint16_t* pixels, int width, int height, ptrdiff_t stride,
                                  double timestamp, double exposure_ms, ldso_frame* frame) {
  return process<std::uint16_t>(slam, {pixels, width, height, stride}, timestamp, exposure_ms, frame);
}

ldso_status ldso_slam_process_f32(ldso_slam* slam, const float* pixels, int width, int height, ptrdiff_t stride,
                                  double timestamp, double exposure_ms, ldso_frame* frame) {
  return process<float>(slam, {pixels, width, height, stride}, timestamp, exposure_ms, frame);
}

const char* ldso_slam_reason(const ldso_slam* slam) { return slam != nullptr ? slam->newest.reason.c_str() : ""; }

int ldso_slam_pose(const ldso_slam* slam, ldso_pose* pose) {
  return guarded(0, [&] {
    require(slam, "slam");
    require(pose, "pose");
    const std::optional<ldso::SE3d> T = slam->slam.T_world_camera();
    if (T) *pose = ldso::c::to_pose({slam->newest.frame_id, slam->newest.timestamp, *T});
    return T ? 1 : 0;
  });
}

ldso_result* ldso_slam_snapshot(const ldso_slam* slam) {
  return guarded<ldso_result*>(nullptr, [&] {
    require(slam, "slam");
    return to_result(slam->slam.snapshot());
  });
}

ldso_result* ldso_slam_finish(ldso_slam* slam) {
  return guarded<ldso_result*>(nullptr, [&] {
    require(slam, "slam");
    return to_result(slam->slam.finish());
  });
}

void ldso_slam_free(ldso_slam* slam) { delete slam; }
}
