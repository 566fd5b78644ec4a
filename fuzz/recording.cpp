// recording.ldso: replayed, exported, made smaller for the report.

#include "fuzz_target.h"
#include "viewer/recording/recorded_map.h"
#include "viewer/recording/recording_file.h"
#include "viewer/recording/recording_limits.h"

using namespace ldso;

namespace {

void check(const RecordedMap& map) {
  const PinholeIntrinsics& c = map.camera;
  fuzz::expect(fuzz::all_finite({c.fx, c.fy, c.cx, c.cy}) && c.width >= 0 && c.height >= 0, "a camera is finite");
  fuzz::expect(map.corrected.size() == map.keyframes.size(), "each keyframe has its pose");
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const protocol::Keyframe& keyframe = map.keyframes[i];
    fuzz::expect(keyframe.T_world_camera.matrix().allFinite(), "a pose is finite");
    fuzz::expect(map.corrected[i].matrix().allFinite() && map.corrected[i].scale() > 0, "so is the corrected one");
    fuzz::expect(keyframe.depth_stddev.size() == keyframe.points.size(), "each point has its deviation");
    for (const Eigen::Vector3f& point : keyframe.points) fuzz::expect(point.allFinite(), "a point is finite");
  }
}

std::size_t points_of(const RecordedMap& map) {
  std::size_t count = 0;
  for (const protocol::Keyframe& keyframe : map.keyframes) count += keyframe.points.size();
  return count;
}

}  // namespace

LDSO_FUZZ_TARGET(recording) {
  const Bytes bytes(input.begin(), input.end());
  LiveMap replayed;
  if (fuzz::succeeds([&] { read_recording(fuzz::scratch_file("recording.ldso", input), replayed); })) {
    MapCursor cursor;
    while (!replayed.next(cursor, 1000).empty()) continue;
    const Bytes snapshot = replayed.snapshot();
    const auto first = fuzz::accepted([&] { return decode_recorded_map(bytes, "recording"); });
    const auto again = fuzz::accepted([&] { return decode_recorded_map(snapshot, "again"); });
    fuzz::expect(first.has_value() == again.has_value(), "what is replayed is what was recorded");
    if (first) fuzz::expect(points_of(*first) == points_of(*again), "with as many points");
  }
  if (const auto map = fuzz::accepted([&] { return decode_recorded_map(bytes, "recording"); })) check(*map);
  const RecordingLimits limits{3, 2, 2, 2};
  const auto limited = fuzz::accepted([&] { return limit_recording(bytes, limits, "recording"); });
  if (limited) limit_recording(limited->bytes, limits, "limited");
}
