#include "image/packed_frame.h"

#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

namespace ldso {
namespace {

/// 65535 is as bright as 255 (RawFrame).
constexpr float kFineSteps = 257.0f;

template <class T>
float fine_steps() {
  return std::is_same_v<T, std::uint16_t> ? kFineSteps : 1.0f;
}

/// The grey levels as whole numbers of steps; none if that loses anything.
template <class T>
std::optional<Image<T>> packed(const Image<float>& grey) {
  Image<T> result(grey.width(), grey.height());
  const float steps = fine_steps<T>();
  for (std::size_t i = 0; i < grey.size(); ++i) {
    const float value = std::nearbyint(grey.data()[i] * steps);
    if (!(value >= 0 && value <= static_cast<float>(std::numeric_limits<T>::max()))) return std::nullopt;
    const T whole = static_cast<T>(value);
    if (static_cast<float>(whole) * (1.0f / steps) != grey.data()[i]) return std::nullopt;
    result.data()[i] = whole;
  }
  return result;
}

template <class T>
Image<float> unpacked(const Image<T>& pixels) {
  Image<float> grey(pixels.width(), pixels.height());
  const float per_step = 1.0f / fine_steps<T>();
  for (std::size_t i = 0; i < pixels.size(); ++i) grey.data()[i] = static_cast<float>(pixels.data()[i]) * per_step;
  return grey;
}

}  // namespace

PackedFrame::PackedFrame(const RawFrame& raw) {
  frame_.id = raw.id;
  frame_.timestamp = raw.timestamp;
  frame_.exposure_ms = raw.exposure_ms;
  frame_.name = raw.name;
  if (auto bytes = packed<std::uint8_t>(raw.grey)) {
    pixels_ = std::move(*bytes);
  } else if (auto words = packed<std::uint16_t>(raw.grey)) {
    pixels_ = std::move(*words);
  } else {
    pixels_ = raw.grey;
  }
}

RawFrame PackedFrame::unpack() const {
  RawFrame raw = frame_;
  raw.grey = std::visit([](const auto& pixels) { return unpacked(pixels); }, pixels_);
  return raw;
}

std::size_t PackedFrame::bytes() const {
  return std::visit([](const auto& pixels) { return pixels.size() * sizeof(*pixels.data()); }, pixels_);
}

}  // namespace ldso
