#include "slam/second_start.h"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "ldso/slam.h"
#include "slam/pipeline.h"
#include "slam/test_scene.h"

namespace ldso {
namespace {

constexpr int kFrames = 60;

Settings two_maps(double most_residual) {
  Settings settings;
  settings.loops.enabled = false;
  settings.revision.frames = 200;        // No backward pass within the frames there are,
  settings.revision.least_frames = 200;  // nor at their end.
  settings.revision.second_parallax_angle = 6;
  settings.revision.second_frames = 40;
  settings.revision.most_residual = most_residual;
  return settings;
}

SlamResult run(const Settings& settings, std::string& log) {
  Pipeline pipeline(scene_calibration(), settings, [&](LogLevel, const std::string& line) { log += line + "\n"; });
  for (int i = 0; i < kFrames; ++i) {
    const auto raw = std::make_shared<RawFrame>(raw_frame(i, draw_scene(i)));
    pipeline.process(std::make_shared<const PreparedFrame>(pipeline.preprocessor().process(*raw)), raw);
  }
  return pipeline.finish();
}

/// Each pose has its keyframe, and each keyframe that is marked as one exists.
void expect_consistent(const SlamResult& result) {
  std::set<std::int64_t> keyframes;
  for (const KeyframeUpdate& keyframe : result.keyframes) {
    EXPECT_TRUE(keyframes.insert(keyframe.frame_id).second) << keyframe.frame_id;
  }
  for (const FrameRecord& frame : result.frames) {
    if (frame.state != TrackingState::kTracked) continue;
    EXPECT_TRUE(keyframes.contains(frame.keyframe_id)) << frame.frame_id;
    EXPECT_TRUE(!frame.is_keyframe || keyframes.contains(frame.frame_id)) << frame.frame_id;
  }
}

TEST(SecondStart, TheBetterMapIsKeptAndTheRunGoesOnInIt) {
  std::string log;
  const SlamResult first = run(two_maps(0), log);  // Residuals are never that small.
  EXPECT_EQ(log.find("takes the place"), std::string::npos) << log;
  const SlamResult second = run(two_maps(1e3), log);  // Always.
  EXPECT_NE(log.find("takes the place"), std::string::npos) << log;
  ASSERT_EQ(first.initializations.size(), 1u);
  ASSERT_EQ(second.initializations.size(), 1u);
  EXPECT_GT(second.initializations.front(), first.initializations.front()) << "it waits for more parallax";
  for (const SlamResult* result : {&first, &second}) {
    expect_consistent(*result);
    EXPECT_EQ(result->frames.size(), static_cast<std::size_t>(kFrames));
    EXPECT_EQ(result->trajectory().size(), static_cast<std::size_t>(kFrames));
    EXPECT_EQ(result->restarts, 0);
  }
}

TEST(SecondStart, IsTheSameForAnyNumberOfThreads) {
  std::string log;
  Settings settings = two_maps(1e3);
  settings.threads = 1;
  const SlamResult one = run(settings, log);
  settings.threads = 3;
  const SlamResult three = run(settings, log);
  ASSERT_EQ(one.trajectory().size(), three.trajectory().size());
  for (std::size_t i = 0; i < one.trajectory().size(); ++i) {
    EXPECT_EQ(one.trajectory()[i].T_world_camera.matrix(), three.trajectory()[i].T_world_camera.matrix()) << i;
  }
}

TEST(SecondStart, WithoutMoreParallaxThereIsNone) {
  std::string log;
  Settings settings = two_maps(1e3);
  settings.revision.second_parallax_angle = 0;
  run(settings, log);
  EXPECT_EQ(log.find("takes the place"), std::string::npos) << log;
}

/// Whether the second of two maps that wait for the same parallax begins at another frame than the first.
bool begins_later(const Settings& settings, int& first_start) {
  ThreadPool pool(1), second_pool(1);
  const FramePreprocessor preprocessor(scene_calibration(), settings.photometry);
  Odometry odometry(preprocessor.output_camera(), 0, true, settings, pool);
  Settings same = settings;
  same.revision.second_parallax_angle = settings.initializer.good_parallax_angle;
  SecondStart second(odometry, same, second_pool);
  std::vector<FrameRecord> records;
  first_start = -1;
  for (int i = 0; i < kFrames; ++i) {
    const auto frame = std::make_shared<const PreparedFrame>(preprocessor.process(raw_frame(i, draw_scene(i))));
    records.push_back(odometry.process(frame).frame);
    if (first_start < 0 && records.back().state == TrackingState::kTracked) first_start = i;
    if (second.add(frame, nullptr, records.back())) break;
  }
  std::string verdict;
  const std::optional<SecondMap> map = second.finish(records, verdict);
  EXPECT_EQ(map.has_value(), !verdict.empty());
  EXPECT_TRUE(!map || map->start > first_start);
  return map.has_value();
}

TEST(SecondStart, TwoMapsThatBeginTogetherAreOne) {
  int first_start = -1;
  EXPECT_FALSE(begins_later(two_maps(1e3), first_start));
  EXPECT_LT(first_start, 12) << "the scene's motion allows a prompt start";
}

TEST(SecondStart, BeginsOnceMoreIfBothHadToWaitForTheSameFrame) {
  Settings waiting = two_maps(1e3);
  waiting.revision.second_frames = 30;
  waiting.initializer.good_parallax_angle = 12;
  waiting.initializer.min_parallax_angle = 10;
  int first_start = -1;
  EXPECT_TRUE(begins_later(waiting, first_start));
  EXPECT_GT(first_start, 12);
}

}  // namespace
}  // namespace ldso
