#include "slam/backward_pass.h"

#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "mapping/map/reversed_constraint.h"
#include "odometry/tracking/frame_record.h"

namespace ldso {
namespace {

/// Frames in a row that may fail before the camera is given up as lost.
constexpr int kForgivenFrames = 3;

/// Keyframes that left the window of a pass.
class PassKeyframes {
 public:
  PassKeyframes(const Window& window, PackedFrames frames) : frames_(frames) {
    for (const auto& keyframe : window.keyframes) given_.insert(keyframe->frame);
  }

  /// Where a frame that was a keyframe before has become one again, the new one counts: frames were tracked with that.
  /// Both may have been in the window at once: that they lie at the same place is no constraint.
  void add(std::vector<FinishedKeyframe> finished) {
    for (FinishedKeyframe& keyframe : finished) {
      const bool is_given = given_.contains(keyframe.frame);
      const auto [it, is_first] = by_id_.try_emplace(keyframe.update.frame_id);
      if (!is_first && is_given) continue;
      pack(frames_, keyframe);
      std::erase_if(keyframe.update.constraints, [&](const KeyframeConstraint& constraint) {
        return constraint.keyframe_id == keyframe.update.frame_id;
      });
      it->second = {std::move(keyframe), is_given, false};
    }
  }

  const SE3d& T_world_camera(std::int64_t id) const { return by_id_.at(id).finished.update.T_world_camera; }

  /// A keyframe that the pass began with was tracked like other frames: that is where it is. Whether it is one.
  bool move_given(std::int64_t id, const SE3d& T_world_camera) {
    const auto it = by_id_.find(id);
    if (it == by_id_.end() || !it->second.is_given) return false;
    it->second.finished.update.T_world_camera = T_world_camera;
    it->second.is_moved = true;
    return true;
  }

  /// Those older than keyframe `turn`, newest first. The others exist outside of the pass as well; what they know of
  /// where the older ones are goes over to these.
  std::vector<FinishedKeyframe> take_older(std::int64_t turn) {
    const auto end = by_id_.lower_bound(turn);
    for (auto& [id, keyframe] : by_id_) {
      for (KeyframeConstraint& constraint : keyframe.finished.update.constraints) {
        const auto other = by_id_.find(constraint.keyframe_id);
        if (other == by_id_.end()) continue;
        if (keyframe.is_moved || other->second.is_moved) {
          constraint.T_this_other = T_world_camera(id).inverse() * T_world_camera(other->first);
        }
        if (id >= turn && other->first < turn) {
          other->second.finished.update.constraints.push_back(reversed(id, constraint));
        }
      }
    }
    std::vector<FinishedKeyframe> older;
    for (auto it = std::make_reverse_iterator(end); it != by_id_.rend(); ++it) {
      older.push_back(std::move(it->second.finished));
    }
    return older;
  }

 private:
  struct PassKeyframe {
    FinishedKeyframe finished;
    bool is_given = false;  ///< The pass began with it.
    bool is_moved = false;  ///< It has been tracked since.
  };
  PackedFrames frames_;
  std::set<std::shared_ptr<const PreparedFrame>> given_;  ///< Images of the keyframes that the pass began with.
  std::map<std::int64_t, PassKeyframe> by_id_;
};

/// Tracks the frames until the camera is lost; their records, newest first.
std::vector<FrameRecord> track_back(Odometry& back, PackedFrames frames, const FramePreprocessor& preprocessor,
                                    const std::stop_token& stop, PassKeyframes& keyframes) {
  std::vector<FrameRecord> records;
  int lost = 0;
  for (auto it = frames.rbegin(); it != frames.rend(); ++it) {
    if (stop.stop_requested()) break;
    OdometryOutput output = back.process(std::make_shared<const PreparedFrame>(preprocessor.process((*it)->unpack())));
    keyframes.add(std::move(output.finished));
    if (back.restarts() > 0) break;
    lost = output.frame.state == TrackingState::kTracked ? 0 : lost + 1;
    if (lost > kForgivenFrames) break;
    if (lost == 0) records.push_back(std::move(output.frame));
  }
  keyframes.add(back.window_keyframes());
  return records;
}

}  // namespace

BackwardPass pass_back(Odometry& back, PackedFrames frames, const FramePreprocessor& preprocessor,
                       const std::stop_token& stop) {
  const std::int64_t turn = back.window().keyframes.back()->id();
  PassKeyframes keyframes(back.window(), frames);
  std::vector<FrameRecord> records = track_back(back, frames, preprocessor, stop, keyframes);
  BackwardPass pass;
  pass.T_world_turn = keyframes.T_world_camera(turn);
  for (FrameRecord& record : records) {
    if (record.frame_id >= turn) continue;
    const SE3d T_world_camera = keyframes.T_world_camera(record.keyframe_id) * record.T_keyframe_frame;
    if (record.keyframe_id >= turn) {
      record.keyframe_id = turn;
      record.T_keyframe_frame = pass.T_world_turn.inverse() * T_world_camera;
    }
    if (keyframes.move_given(record.frame_id, T_world_camera)) record_keyframe(record);
    pass.frames.push_back({std::move(record), T_world_camera});
  }
  pass.keyframes = keyframes.take_older(turn);
  return pass;
}

}  // namespace ldso
