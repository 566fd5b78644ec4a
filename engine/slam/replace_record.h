#pragma once

#include <algorithm>
#include <vector>

#include "ldso/records.h"

namespace ldso {

/// What was said of a frame is superseded; nothing is done if nothing was. Late records are of the last few frames:
/// the search from the back is short. Whether the frame had a pose and has none any more.
inline bool replace_record(std::vector<FrameRecord>& records, const FrameRecord& late) {
  const auto same = std::find_if(records.rbegin(), records.rend(),
                                 [&](const FrameRecord& record) { return record.frame_id == late.frame_id; });
  if (same == records.rend()) return false;
  const bool loses_pose = same->state == TrackingState::kTracked && late.state != TrackingState::kTracked;
  *same = late;
  return loses_pose;
}

}  // namespace ldso
