#include "viewer/map/pose_history.h"

#include <gtest/gtest.h>

#include <map>

namespace ldso {
namespace {

/// All of `keyframes` at x.
protocol::Poses step(std::int64_t at_frame, const std::vector<std::int64_t>& keyframes, double x) {
  protocol::Poses made;
  made.at_frame = at_frame;
  made.correction = Sim3d(SO3d(), {x, 0, 0}, 1.0);
  for (const std::int64_t id : keyframes) made.poses.push_back({id, Sim3d(SO3d(), {x, 0, 0}, 1.0)});
  return made;
}

std::map<std::int64_t, double> last_known(const PoseHistory& history) {
  std::map<std::int64_t, double> known;
  for (const protocol::Poses& s : history.steps()) {
    for (const KeyframePose& pose : s.poses) known[pose.keyframe_id] = pose.S_world_keyframe.translation().x();
  }
  return known;
}

TEST(PoseHistory, KeepsAllStepsThatFit) {
  PoseHistory history(100);
  for (int i = 0; i < 10; ++i) history.add(step(i, {i}, i));
  EXPECT_EQ(history.steps().size(), 10u);
  EXPECT_EQ(history.poses(), 10u);
  history.clear();
  EXPECT_TRUE(history.steps().empty());
}

TEST(PoseHistory, ForgetsStepsInBetweenButNotTheEnd) {
  PoseHistory history(40);
  std::map<std::int64_t, double> wanted;
  for (int i = 0; i < 60; ++i) {
    const std::vector<std::int64_t> ids = {i % 7, i % 5, 20 + i % 3};
    history.add(step(i, ids, i));
    for (const std::int64_t id : ids) wanted[id] = i;
    EXPECT_LE(history.poses(), 40u);
    EXPECT_EQ(last_known(history), wanted);
  }
  EXPECT_GT(history.steps().size(), 2u);
  for (std::size_t i = 1; i < history.steps().size(); ++i)
    EXPECT_GT(history.steps()[i].at_frame, history.steps()[i - 1].at_frame);
  EXPECT_EQ(history.steps().back().at_frame, 59);
  EXPECT_EQ(history.steps().back().correction.translation().x(), 59);
}

TEST(PoseHistory, OneStepIsKeptHoweverLargeItIs) {
  PoseHistory history(2);
  history.add(step(0, {1, 2, 3, 4}, 1));
  history.add(step(1, {4, 5}, 2));
  ASSERT_EQ(history.steps().size(), 1u);
  EXPECT_EQ(history.steps()[0].poses.size(), 5u);
}

}  // namespace
}  // namespace ldso
