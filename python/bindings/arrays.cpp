#include "bindings/arrays.h"

#include <memory>

#include "ldso/error.h"

namespace ldso::python {

namespace py = pybind11;

namespace {

py::array_t<double> matrix_array(const Eigen::Matrix4d& matrix) {
  py::array_t<double> array({4, 4});
  auto to = array.mutable_unchecked<2>();
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) to(row, column) = matrix(row, column);
  }
  return array;
}

}  // namespace

py::array_t<double> to_array(const SE3d& T) { return matrix_array(T.matrix()); }
py::array_t<double> to_array(const Sim3d& S) { return matrix_array(S.matrix()); }

SE3d to_pose(const py::array_t<double>& matrix, const std::string& what) {
  if (matrix.ndim() != 2 || matrix.shape(0) != 4 || matrix.shape(1) != 4)
    throw Error(what, "it is no 4 x 4 matrix", "pass T_world_camera as an array of shape (4, 4)");
  const auto from = matrix.unchecked<2>();
  Eigen::Matrix4d T;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) T(row, column) = from(row, column);
  }
  return SE3d::from_matrix(T);
}

py::array_t<float> to_array(Image<float> image) {
  auto* kept = new Image<float>(std::move(image));
  const py::capsule owner(kept, [](void* pixels) { delete static_cast<Image<float>*>(pixels); });
  return py::array_t<float>({kept->height(), kept->width()}, kept->data(), owner);
}

template <class T>
bool ImageArgument::take() {
  if (!py::isinstance<py::array_t<T>>(array_)) return false;
  constexpr auto kSize = static_cast<py::ssize_t>(sizeof(T));
  const bool is_right = array_.strides(1) == kSize && array_.strides(0) % kSize == 0 && array_.strides(0) > 0;
  if (!is_right) array_ = py::array_t<T, py::array::c_style | py::array::forcecast>(array_);
  view_ = ImageView<const T>{static_cast<const T*>(array_.data()), static_cast<int>(array_.shape(1)),
                             static_cast<int>(array_.shape(0)), array_.strides(0) / kSize};
  return true;
}

ImageArgument::ImageArgument(const py::object& image) {
  if (!py::isinstance<py::array>(image)) {
    throw Error("image", "it is a " + std::string(py::str(py::type::of(image).attr("__name__"))),
                "pass a numpy array of shape (height, width)");
  }
  array_ = py::reinterpret_borrow<py::array>(image);
  if (array_.ndim() != 2) {
    throw Error("image", "it has " + std::to_string(array_.ndim()) + " dimensions",
                "pass one grey image of shape (height, width): cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)");
  }
  if (take<std::uint8_t>() || take<std::uint16_t>() || take<float>()) return;
  throw Error("image", "its type is " + std::string(py::str(array_.dtype())),
              "convert it: uint8, uint16 (full range) or float32 (grey levels 0..255)");
}

}  // namespace ldso::python
