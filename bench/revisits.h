#pragma once
// Where a run came back to what it had seen, by the truth, and what loop closing made of it.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "keyframe_run.h"

namespace ldso {

struct RevisitOptions {
  double overlap = 0.4;      ///< Of both views, at least.
  double angle_deg = 30;     ///< Between both, at most.
  double seconds = 3;        ///< Between both, at least.
  int bridged = 2;           ///< Keyframes without a revisit that do not end a stretch.
  double longest = 3;        ///< A stretch; longer ones are cut into equal pieces no longer than this [s].
  double translation = 0.1;  ///< A loop is wrong if it is farther off than this share of the depth
  double relative = 0.25;    ///< and this share of the true distance of both keyframes,
  double rotation_deg = 5;   ///< or turned by more than this.
};

/// Whether two keyframes see the same from about the same side.
bool sees_same(const KeyframeRun& run, int a, int b, const RevisitOptions& options);

/// The keyframe seen before `index`, out of its window, that sees most of the same; none if none sees enough.
std::optional<int> best_revisited(const KeyframeRun& run, int index, const RevisitOptions& options);

/// Keyframes that see, one after the other, what one from before saw.
struct Stretch {
  std::int64_t first_frame = 0, last_frame = 0;
  bool closed = false;  ///< An accepted loop that is right ends in it.
};

/// All of a run, in the order of time.
std::vector<Stretch> find_stretches(const KeyframeRun& run, const RevisitOptions& options);

/// Whether the truth contradicts the record's similarity; nothing where there is no truth.
std::optional<bool> is_wrong(const KeyframeRun& run, const LoopRecord& record, const RevisitOptions& options);

/// Index of the keyframe of a frame.
int index_of(const KeyframeRun& run, std::int64_t frame_id);

}  // namespace ldso
