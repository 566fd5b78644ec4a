#include "slam/live_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <mutex>

#include "ldso/slam.h"
#include "slam/test_scene.h"

namespace ldso {
namespace {

/// Keeps everything it hears of.
class Listener final : public RunObserver {
 public:
  int starts = 0;
  bool wants = true;
  std::map<std::int64_t, FrameEvent> frames;
  std::vector<KeyframeUpdate> keyframes;
  std::vector<LiveView> views;

  void on_start(const PinholeIntrinsics&) override { ++starts; }
  void on_frame(FrameEvent event) override { frames[event.frame.frame_id] = std::move(event); }
  void on_keyframe(const KeyframeUpdate& keyframe, const PinholeIntrinsics&) override { keyframes.push_back(keyframe); }
  void on_loops(LoopEvent event) override {
    const std::lock_guard lock(mutex_);
    loops_.push_back(std::move(event));
  }
  bool wants_view() override { return wants; }
  void on_view(LiveView view) override { views.push_back(std::move(view)); }
  std::vector<LoopEvent> loops() {
    const std::lock_guard lock(mutex_);
    return loops_;
  }

 private:
  std::mutex mutex_;
  std::vector<LoopEvent> loops_;
};

SlamResult run(int frames, const std::shared_ptr<RunObserver>& observer) {
  Slam slam(scene_calibration(), Settings{}, {}, observer);
  for (int i = 0; i < frames; ++i) {
    const Image<std::uint8_t> image = draw_scene(i);
    slam.process(image.view(), 0.1 * i);
  }
  return slam.finish();
}

TEST(RunObserver, ChangesNothing) {
  const SlamResult alone = run(40, nullptr);
  const SlamResult watched = run(40, std::make_shared<Listener>());
  ASSERT_GT(alone.trajectory().size(), 20u);
  ASSERT_EQ(alone.trajectory().size(), watched.trajectory().size());
  for (std::size_t i = 0; i < alone.trajectory().size(); ++i) {
    EXPECT_EQ(alone.trajectory()[i].T_world_camera.matrix(), watched.trajectory()[i].T_world_camera.matrix());
  }
  ASSERT_EQ(alone.points().size(), watched.points().size());
  for (std::size_t i = 0; i < alone.points().size(); ++i) {
    EXPECT_EQ(alone.points()[i].position, watched.points()[i].position);
  }
}

TEST(RunObserver, HearsOfEverything) {
  const auto listener = std::make_shared<Listener>();
  const SlamResult result = run(40, listener);
  EXPECT_EQ(listener->starts, 1);
  ASSERT_EQ(listener->frames.size(), result.frames.size());
  for (const FrameRecord& frame : result.frames) {
    EXPECT_EQ(listener->frames[frame.frame_id].frame.state, frame.state) << frame.frame_id;
    EXPECT_EQ(listener->frames[frame.frame_id].T_world_camera.has_value(), frame.state == TrackingState::kTracked);
  }
  ASSERT_EQ(listener->keyframes.size(), result.keyframes.size());
  const std::vector<LoopEvent> loops = listener->loops();
  ASSERT_EQ(loops.size(), result.keyframes.size());
  for (const LoopEvent& event : loops) EXPECT_EQ(event.poses.size(), 1u);  // Nothing is closed here.
}

TEST(RunObserver, ViewsShowTheFrameWithItsPoints) {
  const auto listener = std::make_shared<Listener>();
  run(40, listener);
  ASSERT_EQ(listener->views.size(), 40u);
  const LiveView& view = listener->views.back();
  EXPECT_EQ(view.frame_id, 39);
  ASSERT_TRUE(view.T_world_camera);
  EXPECT_GE(view.window.size(), 2u);
  const auto is_candidate = [](const ViewPixel& pixel) { return pixel.is_candidate; };
  EXPECT_GT(std::count_if(view.pixels.begin(), view.pixels.end(), is_candidate), 50);
  EXPECT_GT(std::count_if(view.pixels.begin(), view.pixels.end(), std::not_fn(is_candidate)), 100);
  for (const ViewPixel& pixel : view.pixels) {
    EXPECT_GE(pixel.u, 0);
    EXPECT_LE(pixel.u, view.camera.width - 1);
    EXPECT_GE(pixel.v, 0);
    EXPECT_LE(pixel.v, view.camera.height - 1);
  }
  const Image<float> image = view.image();
  const Image<std::uint8_t> drawn = draw_scene(39);
  ASSERT_EQ(image.width(), drawn.width());
  EXPECT_NEAR(image(100, 100), drawn(100, 100), 1);
}

TEST(RunObserver, GetsNoViewThatItDoesNotWant) {
  const auto listener = std::make_shared<Listener>();
  listener->wants = false;
  run(10, listener);
  EXPECT_TRUE(listener->views.empty());
  EXPECT_EQ(listener->frames.size(), 10u);
}

}  // namespace
}  // namespace ldso
