#include "image/compact_frame.h"

#include <cstddef>

#include "image/pyramid.h"

namespace ldso {
namespace {

std::vector<bool> validity(const Image<Texel>& texels) {
  std::vector<bool> valid(texels.size());
  for (std::size_t i = 0; i < texels.size(); ++i) valid[i] = texels.data()[i].valid > 0;
  return valid;
}

/// Texels that may not be used have no gradient.
void invalidate(const std::vector<bool>& valid, Image<Texel>& texels) {
  for (std::size_t i = 0; i < texels.size(); ++i) {
    if (!valid[i]) texels.data()[i] = {texels.data()[i].intensity, 0, 0, 0};
  }
}

}  // namespace

CompactFrame::CompactFrame(const PreparedFrame& frame) {
  frame_.id = frame.id;
  frame_.timestamp = frame.timestamp;
  frame_.exposure_ms = frame.exposure_ms;
  frame_.exposure_known = frame.exposure_known;
  for (const Image<Texel>& level : frame.pyramid.levels) valid_.push_back(validity(level));
  if (frame.pyramid.levels.empty()) return;
  const Image<Texel>& finest = frame.pyramid.levels.front();
  intensities_ = Image<float>(finest.width(), finest.height(), Uninitialized{});
  for (std::size_t i = 0; i < finest.size(); ++i) intensities_.data()[i] = finest.data()[i].intensity;
}

PreparedFrame CompactFrame::unpack() const {
  PreparedFrame frame = frame_;
  if (valid_.empty()) return frame;
  frame.pyramid = build_pyramid(intensities_.view());
  for (std::size_t level = 0; level < valid_.size(); ++level) invalidate(valid_[level], frame.pyramid.levels[level]);
  return frame;
}

}  // namespace ldso
