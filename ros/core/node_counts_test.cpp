#include "core/node_counts.h"

#include <gtest/gtest.h>

namespace ldso::ros {
namespace {

FrameRecord record(TrackingState state, const std::string& reason = "") {
  FrameRecord result;
  result.state = state;
  result.reason = reason;
  return result;
}

TEST(NodeCounts, SayWhatTheNodeWaitsFor) {
  NodeCounts counts;
  EXPECT_EQ(status_of(counts).message, "waiting for camera_info");
  EXPECT_EQ(status_of(counts).level, NodeLevel::kWarning);
  counts.has_camera = true;
  EXPECT_EQ(status_of(counts).message, "waiting for images");
  counts.images = counts.refused = 1;
  EXPECT_EQ(status_of(counts).level, NodeLevel::kError);
  counts.add(record(TrackingState::kInitializing, "too little motion"), 10);
  EXPECT_EQ(status_of(counts).message, "waiting for a map: too little motion");
  counts.add(record(TrackingState::kTracked), 20);
  EXPECT_EQ(status_of(counts).message, "tracking");
  EXPECT_EQ(status_of(counts).level, NodeLevel::kOk);
  counts.add(record(TrackingState::kLost, "too few points"), 30);
  EXPECT_EQ(status_of(counts).message, "lost: too few points");
  EXPECT_EQ(status_of(counts).level, NodeLevel::kError);
}

TEST(NodeCounts, CountLossesAndTimes) {
  NodeCounts counts;
  for (const TrackingState state : {TrackingState::kInitializing, TrackingState::kTracked, TrackingState::kLost,
                                    TrackingState::kLost, TrackingState::kTracked, TrackingState::kLost})
    counts.add(record(state), 3);
  EXPECT_EQ(counts.losses, 2);
  EXPECT_EQ(counts.processed, 6);
  const std::vector<std::pair<std::string, std::string>> figures = status_of(counts).figures;
  EXPECT_EQ(figures[1], std::pair(std::string("processed"), std::string("6")));
  EXPECT_EQ(figures.back().second, "3");
}

}  // namespace
}  // namespace ldso::ros
