#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace ldso {

/// Non-owning view of a row-major, single-plane image. `stride` counts elements, not bytes.
/// Pixel centres are at integer coordinates, (0, 0) is the centre of the upper left pixel.
template <class T>
struct ImageView {
  T* data = nullptr;
  int width = 0;
  int height = 0;
  std::ptrdiff_t stride = 0;

  T& operator()(int x, int y) const { return data[y * stride + x]; }
  T* row(int y) const { return data + y * stride; }
  bool empty() const { return width == 0 || height == 0; }

  /// A view to write through is also one to read through, as with std::span.
  operator ImageView<const T>() const requires(!std::is_const_v<T>) { return {data, width, height, stride}; }
};

/// Says that the pixels of a new image are about to be written, so that they need no value first.
struct Uninitialized {};

/// Owning, contiguous, row-major image (stride equals width).
template <class T>
class Image {
 public:
  Image() = default;
  Image(int width, int height, const T& value = T{})
      : width_(width), height_(height), pixels_(static_cast<std::size_t>(width) * height, value) {}

  Image(int width, int height, Uninitialized)
      : width_(width), height_(height), pixels_(static_cast<std::size_t>(width) * height) {}

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t size() const { return pixels_.size(); }
  bool empty() const { return pixels_.empty(); }

  T& operator()(int x, int y) { return pixels_[static_cast<std::size_t>(y) * width_ + x]; }
  const T& operator()(int x, int y) const { return pixels_[static_cast<std::size_t>(y) * width_ + x]; }
  T* row(int y) { return pixels_.data() + static_cast<std::size_t>(y) * width_; }
  const T* row(int y) const { return pixels_.data() + static_cast<std::size_t>(y) * width_; }
  T* data() { return pixels_.data(); }
  const T* data() const { return pixels_.data(); }

  ImageView<T> view() { return {data(), width_, height_, width_}; }
  ImageView<const T> view() const { return {data(), width_, height_, width_}; }

 private:
  /// Leaves what is made without a value as the memory is.
  struct Allocator : std::allocator<T> {
    template <class U>
    struct rebind {
      using other = typename Image<U>::Allocator;
    };
    template <class U, class... Arguments>
    void construct(U* p, Arguments&&... arguments) {
      constexpr bool keeps_memory = sizeof...(Arguments) == 0 && std::is_trivially_copyable_v<U>;
      if constexpr (!keeps_memory) std::construct_at(p, std::forward<Arguments>(arguments)...);
    }
  };

  int width_ = 0;
  int height_ = 0;
  std::vector<T, Allocator> pixels_;
};

}  // namespace ldso
