#pragma once

// A second odometry beside the first one, on a thread of its own, on the same frames: it waits for more parallax before
// its map begins. Which of both starts was better nobody can tell from the first two images; a hundred frames later
// their residuals tell. The map of the one that explains the same images worse is given up.

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "image/packed_frame.h"
#include "ldso/settings.h"
#include "odometry/odometry.h"
#include "util/bounded_queue.h"
#include "util/thread_pool.h"

namespace ldso {

/// What the second odometry has come to.
struct SecondMap {
  std::unique_ptr<Odometry> odometry;
  std::vector<FrameRecord> records;         ///< Of all frames, as they are known now.
  std::vector<FinishedKeyframe> keyframes;  ///< That left its window, packed where that can be.
  std::int64_t start = -1;                  ///< The frame at which it began.
};

class SecondStart {
 public:
  /// `odometry`: the first one, before its first frame. `pool` is used by the second one alone, and must outlive it.
  SecondStart(const Odometry& odometry, const Settings& settings, ThreadPool& pool);
  ~SecondStart();
  SecondStart(const SecondStart&) = delete;
  SecondStart& operator=(const SecondStart&) = delete;

  /// A frame, as the camera took it if that is known, and what the first odometry said of it. Waits while the second
  /// one is several frames behind. True once all is known that decides: what follows then is finish().
  bool add(const std::shared_ptr<const PreparedFrame>& frame, const std::shared_ptr<const RawFrame>& raw,
           const FrameRecord& first);

  /// The second map, if it is better. `first`: the records of the frames with the first one, as they are known now.
  /// `verdict`: for the log; empty if there is nothing to say.
  std::optional<SecondMap> finish(const std::vector<FrameRecord>& first, std::string& verdict);

 private:
  struct Item {
    std::shared_ptr<const PreparedFrame> frame;
    std::shared_ptr<const RawFrame> raw;
    bool first_begins = false;  ///< The first map begins with this frame.
    bool is_doubtful = false;   ///< It had to be waited for.
  };
  void work(const std::stop_token& stop);
  void process(const Item& item);
  /// Median over the frames that both track of the second map's residuals relative to the first one's; infinite if it
  /// does not track all of them from its start on, or has not begun.
  double residual_ratio(const std::vector<FrameRecord>& first_records) const;

  RevisionSettings settings_;
  std::int64_t first_start_ = -1;  ///< The frame at which the first map began.
  int waited_ = 0;                 ///< Frames before that.
  int age_ = 0;                    ///< Of the first map [frames].
  bool is_over_ = false;           ///< The first map is lost, or both are the same.
  ThreadPool& pool_;
  Settings patient_;  ///< Of the second odometry.
  SecondMap map_;
  std::vector<std::shared_ptr<const PackedFrame>> images_;  ///< Of its keyframes.
  std::atomic<std::int64_t> start_ = -1;                    ///< The frame at which the second map began.
  std::string failure_;
  BoundedQueue<Item> queue_;
  std::jthread thread_;  ///< Declared last: it uses the others and is joined first.
};

}  // namespace ldso
