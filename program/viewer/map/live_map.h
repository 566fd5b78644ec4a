#pragma once

// All that a page has to know of a run, in a form from which each page takes what it has not got yet: one that joins
// late begins at nothing and gets the whole map, one that is slow gets the newest poses and pictures and all of the
// map. Nothing waits in a queue of its own for a page.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ldso/io/trajectory_file.h"
#include "ldso/observer.h"
#include "viewer/map/pose_history.h"
#include "viewer/map/protocol.h"

namespace ldso {

using SharedBytes = std::shared_ptr<const Bytes>;

/// What only counts in its newest form.
enum class LatestSlot { kTruth, kAlignment, kStatus, kWindow, kImage };
inline constexpr std::size_t kLatestSlots = 5;

/// How much of a LiveMap a page has.
struct MapCursor {
  std::uint64_t start = 0;
  std::size_t messages = 0, frames = 0;
  std::uint64_t poses = 0;
  std::array<std::uint64_t, kLatestSlots> latest{};
};

/// To be used by one thread at a time.
class LiveMap {
 public:
  /// An empty map; pages forget theirs. Ground truth and status stay.
  void start(protocol::Hello hello);

  void add(const protocol::Keyframe& keyframe);
  void add(FrameEvent frame);
  void add(LoopEvent loops);
  void add(const protocol::LogLine& line);
  /// Any message that each page is to get once.
  void add_message(Bytes message);
  void set_latest(LatestSlot slot, Bytes message);

  /// The messages that a page with this cursor needs next, in all not many more than `most_bytes`; the cursor is
  /// advanced over them. None if it has everything.
  std::vector<SharedBytes> next(MapCursor& cursor, std::size_t most_bytes) const;

  /// All messages that last, as a page that joins now would get them.
  Bytes snapshot() const;

  /// Where the frames are by what is known now, in the order of their ids: of the largest part of the map, for where
  /// the others lie, which no loop has joined to it, nobody knows.
  Trajectory trajectory() const;

  const protocol::Hello& hello() const { return hello_; }
  std::int64_t newest_frame() const { return newest_frame_; }
  const Sim3d& correction() const { return correction_; }
  std::size_t frames() const { return frames_.size(); }
  const std::vector<FrameEvent>& frame_events() const { return frames_; }
  std::uint64_t pose_revision() const { return pose_revision_; }

 private:
  /// Of the history: 72 bytes each.
  static constexpr std::size_t kMostPoses = 100'000;

  struct PoseEntry {
    SE3d T_world_camera;  ///< Of the odometry.
    Sim3d S_world_keyframe;
    std::uint64_t revision = 0;  ///< When the corrected pose was set last; 0: there is none.
    int segment = 0;
  };
  struct Latest {
    std::uint64_t revision = 0;
    SharedBytes message;
  };
  /// By segment: whether it belongs to the part with most keyframes.
  std::vector<bool> in_main_part() const;
  SharedBytes frames_from(std::size_t& position) const;
  SharedBytes poses_since(std::uint64_t& revision) const;

  protocol::Hello hello_;
  std::uint64_t starts_ = 0;
  std::vector<SharedBytes> messages_;
  std::vector<FrameEvent> frames_;
  std::map<std::int64_t, PoseEntry> poses_;  ///< By keyframe id.
  std::uint64_t pose_revision_ = 0;
  PoseHistory history_{kMostPoses};
  std::vector<std::pair<std::int64_t, std::int64_t>> loops_;  ///< Keyframes that are the same place.
  int newest_segment_ = 0;
  Sim3d correction_;
  std::int64_t newest_frame_ = -1;
  std::array<Latest, kLatestSlots> latest_;
};

}  // namespace ldso
