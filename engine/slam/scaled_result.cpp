#include "slam/scaled_result.h"

#include <cmath>

#include "ldso/error.h"

namespace ldso {
namespace {

void scale(double factor, SE3d& pose) { pose.translation() *= factor; }

/// The unit of the keyframe's points and that of the world change alike.
void scale(double factor, Sim3d& similarity) {
  similarity = Sim3d(similarity.rotation(), similarity.translation() * factor, similarity.scale());
}

void scale(double factor, KeyframeUpdate& keyframe) {
  scale(factor, keyframe.T_world_camera);
  keyframe.readout.head<3>() *= factor;
  for (MapPoint& point : keyframe.points) {
    point.idepth = static_cast<float>(point.idepth / factor);
    point.idepth_stddev = static_cast<float>(point.idepth_stddev / factor);
  }
  // The covariance is that of [translation, rotation, log scale].
  Sim3d::Jacobian D = Sim3d::Jacobian::Identity();
  D.topLeftCorner<3, 3>() *= factor;
  for (KeyframeConstraint& constraint : keyframe.constraints) {
    scale(factor, constraint.T_this_other);
    constraint.covariance = D * constraint.covariance * D;
  }
}

}  // namespace

void scale_result(double factor, SlamResult& result) {
  if (!(factor > 0) || !std::isfinite(factor))
    throw Error("scale", "a factor of " + std::to_string(factor) + " is impossible", "give a positive length");
  for (FrameRecord& frame : result.frames) scale(factor, frame.T_keyframe_frame);
  for (KeyframeUpdate& keyframe : result.keyframes) scale(factor, keyframe);
  for (Sim3d& pose : result.corrected) scale(factor, pose);
  for (LoopRecord& loop : result.loops) {
    scale(factor, loop.S_keyframe_candidate);
    loop.translation_stddev *= factor;
  }
}

}  // namespace ldso
