#include "slam/packed_keyframe.h"

#include <algorithm>

namespace ldso {

void pack(PackedFrames frames, FinishedKeyframe& keyframe) {
  const std::int64_t id = keyframe.update.frame_id;
  const auto found = std::ranges::lower_bound(frames, id, {}, [](const auto& frame) { return frame->id(); });
  if (found == frames.end() || (*found)->id() != id) return;
  keyframe.packed = *found;
  keyframe.frame.reset();
}

void unpack(const FramePreprocessor& preprocessor, FinishedKeyframe& keyframe) {
  if (!keyframe.packed) return;
  keyframe.frame = std::make_shared<const PreparedFrame>(preprocessor.process(keyframe.packed->unpack()));
  keyframe.packed.reset();
}

}  // namespace ldso
