#include "viewer/run_feed.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <thread>

#include "viewer/live_run.h"

namespace ldso {
namespace {

constexpr PinholeIntrinsics kCamera{100, 80, 50, 50, 50, 40};

std::size_t messages_of(const LiveMap& map) {
  MapCursor cursor;
  return map.next(cursor, std::numeric_limits<std::size_t>::max()).size();
}

TEST(RunFeed, NothingOfTheMapIsLostAndOnlyTheNewestViewIsKept) {
  RunFeed feed({});
  LiveMap map;
  feed.on_start(kCamera);
  std::jthread run([&] {
    for (int id = 0; id < 2000; ++id) {
      FrameEvent event;
      event.frame.frame_id = id;
      feed.on_frame(std::move(event));
      if (!feed.wants_view()) continue;
      LiveView newest;
      newest.frame_id = id;
      newest.T_world_camera = SE3d();
      feed.on_view(std::move(newest));
    }
  });
  std::int64_t newest_view = -1;
  while (map.frames() < 2000) {
    feed.request_view();
    if (const auto view = feed.fetch(map)) {
      EXPECT_GT(view->frame_id, newest_view);
      newest_view = view->frame_id;
    }
  }
  EXPECT_EQ(map.newest_frame(), 1999);
}

TEST(RunFeed, ViewsAreWantedOneAtATime) {
  RunFeed feed({});
  EXPECT_FALSE(feed.wants_view());
  feed.request_view();
  EXPECT_TRUE(feed.wants_view());
  feed.on_view({});
  EXPECT_FALSE(feed.wants_view());
}

TEST(RunFeed, ANewBeginningVoidsWhatWasNotFetched) {
  RunFeed feed({});
  LiveMap map;
  feed.on_start(kCamera);
  feed.on_frame({});
  feed.add_log(LogLevel::kWarning, "the calibration is wrong");
  feed.on_start(kCamera);
  feed.fetch(map);
  EXPECT_EQ(map.frames(), 0u);
  EXPECT_EQ(map.hello().epoch, 2u);
  EXPECT_EQ(messages_of(map), 2u);  // hello and log
}

TEST(RunFeed, NothingIsKeptForAViewerThatIsGone) {
  RunFeed feed({});
  LiveMap map;
  feed.on_start(kCamera);
  feed.on_frame({});
  feed.request_view();
  feed.close();
  EXPECT_FALSE(feed.wants_view());
  feed.on_start(kCamera);
  feed.on_frame({});
  feed.on_keyframe({}, kCamera);
  feed.on_loops({});
  feed.on_view({});
  feed.add_log(LogLevel::kWarning, "nobody hears it");
  EXPECT_FALSE(feed.fetch(map));
  EXPECT_EQ(map.frames(), 0u);
  EXPECT_EQ(messages_of(map), 0u);
}

TEST(LiveRun, ItsObserverMayOutliveIt) {
  std::shared_ptr<RunObserver> observer;
  {
    const LiveRun run({});
    observer = run.observer();
  }
  observer->on_start(kCamera);
  observer->on_frame({});
  LiveMap map;
  dynamic_cast<RunFeed&>(*observer).fetch(map);
  EXPECT_EQ(map.frames(), 0u);
}

TEST(RunFeed, KeyframesAndLoopsReachTheMap) {
  RunFeed feed({});
  LiveMap map;
  feed.on_start(kCamera);
  KeyframeUpdate update;
  update.frame_id = 5;
  update.points.resize(3, {1, 2, 0.5f, 0.1f, 9, false});
  feed.on_keyframe(update, kCamera);
  LoopEvent loops;
  loops.poses = {{5, Sim3d()}};
  loops.candidates = 4;
  feed.on_loops(loops);
  feed.fetch(map);
  EXPECT_EQ(feed.loop_candidates(), 4);
  EXPECT_EQ(map.pose_revision(), 1u);
  EXPECT_EQ(messages_of(map), 3u);
}

}  // namespace
}  // namespace ldso
