#include "slam/map_parts.h"

#include <gtest/gtest.h>

namespace ldso {
namespace {

/// Three segments of two, three and two keyframes: frames 0 1 | 10 11 12 | 20 21.
SlamResult three_segments() {
  SlamResult result;
  for (const auto& [segment, ids] :
       {std::pair(0, std::vector{0, 1}), std::pair(1, std::vector{10, 11, 12}), std::pair(2, std::vector{20, 21})}) {
    for (const int id : ids) {
      KeyframeUpdate keyframe;
      keyframe.frame_id = id;
      keyframe.segment = segment;
      result.keyframes.push_back(keyframe);
      FrameRecord frame;
      frame.frame_id = id;
      frame.state = TrackingState::kTracked;
      frame.keyframe_id = id;
      result.frames.push_back(frame);
    }
  }
  return result;
}

LoopRecord loop(std::int64_t from, std::int64_t to, bool accepted, double weight) {
  LoopRecord record;
  record.keyframe_id = from;
  record.candidate_id = to;
  record.accepted = accepted;
  record.graph_weight = weight;
  return record;
}

using Parts = std::vector<int>;

TEST(MapParts, SegmentsWithoutLoopsAreApartTheLargestFirst) {
  EXPECT_EQ(map_parts(three_segments(), Correction::kLoops), (Parts{1, 1, 0, 0, 0, 2, 2}));
}

TEST(MapParts, AClosedLoopJoinsTwoSegments) {
  SlamResult result = three_segments();
  result.loops = {loop(21, 0, true, 1)};
  EXPECT_EQ(map_parts(result, Correction::kLoops), (Parts{0, 0, 1, 1, 1, 0, 0}));
  EXPECT_EQ(map_parts(result, Correction::kNone), (Parts{1, 1, 0, 0, 0, 2, 2})) << "in the odometry they are apart";
}

TEST(MapParts, ALoopThatWasRefusedOrOutvotedJoinsNothing) {
  SlamResult result = three_segments();
  result.loops = {loop(21, 0, false, 1), loop(12, 1, true, 0.01)};
  EXPECT_EQ(map_parts(result, Correction::kLoops), (Parts{1, 1, 0, 0, 0, 2, 2}));
}

TEST(MapParts, PosesAndKeyframesOfAPartAreItsOwn) {
  const SlamResult result = three_segments();
  EXPECT_EQ(result.parts(), 3);
  EXPECT_EQ(result.trajectory().size(), 3u);
  EXPECT_EQ(result.trajectory()[0].frame_id, 10);
  EXPECT_EQ(result.keyframe_trajectory(Correction::kLoops, 1).size(), 2u);
  EXPECT_EQ(result.trajectory(Correction::kLoops, 2)[0].frame_id, 20);
  EXPECT_EQ(SlamResult().parts(), 0);
  EXPECT_TRUE(SlamResult().trajectory().empty());
}

}  // namespace
}  // namespace ldso
