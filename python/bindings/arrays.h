#pragma once

// Poses, points and images as numpy arrays, and back.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "ldso/image.h"
#include "ldso/io/trajectory_file.h"
#include "ldso/se3.h"
#include "ldso/sim3.h"

namespace ldso::python {

/// 4 x 4, camera to world for T_world_camera.
pybind11::array_t<double> to_array(const SE3d& T);
/// 4 x 4; the scale is in the upper left 3 x 3.
pybind11::array_t<double> to_array(const Sim3d& S);

/// From a 4 x 4 matrix. Throws Error, which names `what`, if it is none of a pose.
SE3d to_pose(const pybind11::array_t<double>& matrix, const std::string& what);

/// (count, columns), filled row by row: fill(row, pointer to its first value).
template <class T, class Fill>
pybind11::array_t<T> make_rows(std::size_t count, std::size_t columns, Fill fill) {
  pybind11::array_t<T> array({count, columns});
  T* to = array.mutable_data();
  for (std::size_t i = 0; i < count; ++i) fill(i, to + i * columns);
  return array;
}

/// (count), filled with value(index).
template <class T, class Value>
pybind11::array_t<T> make_column(std::size_t count, Value value) {
  pybind11::array_t<T> array(static_cast<pybind11::ssize_t>(count));
  T* to = array.mutable_data();
  for (std::size_t i = 0; i < count; ++i) to[i] = static_cast<T>(value(i));
  return array;
}

/// (height, width) that owns the pixels: nothing is copied.
pybind11::array_t<float> to_array(Image<float> image);

/// A grey image that a caller gave: seen where it lies if its rows are of one piece, else a copy.
class ImageArgument {
 public:
  using View = std::variant<ImageView<const std::uint8_t>, ImageView<const std::uint16_t>, ImageView<const float>>;

  /// Throws Error if it is not two-dimensional, or of another type than uint8, uint16 and float32.
  explicit ImageArgument(const pybind11::object& image);

  const View& view() const { return view_; }

 private:
  template <class T>
  bool take();

  pybind11::array array_;
  View view_;
};

}  // namespace ldso::python
