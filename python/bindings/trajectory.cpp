#include "bindings/trajectory.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "evaluation/trajectory_source.h"
#include "ldso/error.h"

namespace ldso::python {

namespace py = pybind11;
using py::literals::operator""_a;
using Rows = py::array_t<double, py::array::c_style | py::array::forcecast>;

namespace {

constexpr std::size_t kTumColumns = 8;

py::array_t<double> tum_rows(const Trajectory& trajectory) {
  return make_rows<double>(trajectory.size(), kTumColumns, [&](std::size_t i, double* row) {
    const SE3d& T = trajectory[i].T_world_camera;
    const Eigen::Vector3d& t = T.translation();
    const auto& q = T.rotation().quaternion();
    for (const double value : {trajectory[i].timestamp, t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()})
      *row++ = value;
  });
}

Trajectory from_tum_rows(const Rows& rows) {
  if (rows.ndim() != 2 || rows.shape(1) != static_cast<py::ssize_t>(kTumColumns)) {
    throw Error("trajectory", "it is no array of shape (N, 8)",
                "give rows of timestamp tx ty tz qx qy qz qw, camera to world");
  }
  Trajectory trajectory;
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
    const double* v = rows.data(i, 0);
    const Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
    const bool is_finite = std::isfinite(v[0] + v[1] + v[2] + v[3]) && q.coeffs().allFinite();
    if (!is_finite || !(q.norm() > 0))
      throw Error("trajectory, row " + std::to_string(i), "it is no pose", "leave it out");
    trajectory.push_back({v[0], SE3d(SO3d(q), {v[1], v[2], v[3]})});
  }
  return trajectory;
}

py::array_t<double> pose_matrices(const Trajectory& trajectory) {
  py::array_t<double> poses({static_cast<py::ssize_t>(trajectory.size()), py::ssize_t{4}, py::ssize_t{4}});
  auto to = poses.mutable_unchecked<3>();
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const Eigen::Matrix4d T = trajectory[i].T_world_camera.matrix();
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column) to(static_cast<py::ssize_t>(i), row, column) = T(row, column);
    }
  }
  return poses;
}

NumberedTrajectory from_poses(const Rows& timestamps, const Rows& poses) {
  const bool fits = timestamps.ndim() == 1 && poses.ndim() == 3 && poses.shape(0) == timestamps.shape(0) &&
                    poses.shape(1) == 4 && poses.shape(2) == 4;
  if (!fits) throw Error("trajectory", "times and poses do not fit", "give N times and poses of shape (N, 4, 4)");
  NumberedTrajectory made;
  for (py::ssize_t i = 0; i < poses.shape(0); ++i) {
    const py::array_t<double> pose(std::vector<py::ssize_t>{4, 4}, poses.data(i, 0, 0));
    made.poses.push_back({timestamps.at(i), to_pose(pose, "trajectory, pose " + std::to_string(i))});
  }
  return made;
}

void write_poses(const NumberedTrajectory& trajectory, const std::filesystem::path& path, const std::string& format) {
  if (format == "tum") return write_tum_trajectory(path, trajectory.poses);
  if (format == "kitti") return write_kitti_poses(path, trajectory.poses);
  if (format == "euroc") return write_euroc_trajectory(path, trajectory.poses);
  if (format == "csv") return write_csv_trajectory(path, trajectory.poses);
  throw Error("format " + format, "there is no such format", "take tum, kitti, euroc or csv");
}

}  // namespace

NumberedTrajectory to_numbered(const std::vector<TimedPose>& poses) {
  NumberedTrajectory made;
  for (const TimedPose& pose : poses) {
    made.poses.push_back({pose.timestamp, pose.T_world_camera});
    made.frame_ids.push_back(pose.frame_id);
  }
  return made;
}

Trajectory to_trajectory(const py::object& given) {
  if (py::isinstance<NumberedTrajectory>(given)) return given.cast<const NumberedTrajectory&>().poses;
  if (py::isinstance<py::str>(given) || py::hasattr(given, "__fspath__"))
    return load_trajectory(given.cast<std::filesystem::path>()).poses;
  return from_tum_rows(given.cast<Rows>());
}

void bind_trajectory(py::module_& module) {
  py::class_<NumberedTrajectory>(module, "Trajectory", "Timed camera poses, camera to world.")
      .def(py::init(&from_poses), "timestamps"_a, "poses"_a, "N times [s] and poses of shape (N, 4, 4).")
      .def_static(
          "from_tum",
          [](const Rows& rows) {
            return NumberedTrajectory{from_tum_rows(rows), {}};
          },
          "rows"_a, "From rows of shape (N, 8): timestamp tx ty tz qx qy qz qw.")
      .def_static(
          "read",
          [](const std::filesystem::path& path) {
            return NumberedTrajectory{load_trajectory(path).poses, {}};
          },
          "path"_a, "A TUM, KITTI or EuRoC file, or a sequence that carries its ground truth.")
      .def("write", &write_poses, "path"_a, "format"_a = "tum", "format: tum, kitti, euroc or csv.")
      .def("__len__", [](const NumberedTrajectory& t) { return t.poses.size(); })
      .def_property_readonly(
          "timestamps",
          [](const NumberedTrajectory& t) {
            return make_column<double>(t.poses.size(), [&](std::size_t i) { return t.poses[i].timestamp; });
          },
          "[s], float64 of shape (N,).")
      .def_property_readonly(
          "poses", [](const NumberedTrajectory& t) { return pose_matrices(t.poses); },
          "T_world_camera: float64 of shape (N, 4, 4), lengths in map units.")
      .def_property_readonly(
          "tum", [](const NumberedTrajectory& t) { return tum_rows(t.poses); },
          "Rows of a TUM file: float64 of shape (N, 8), timestamp tx ty tz qx qy qz qw.")
      .def_property_readonly(
          "frame_ids",
          [](const NumberedTrajectory& t) {
            return make_column<std::int64_t>(t.frame_ids.size(), [&](std::size_t i) { return t.frame_ids[i]; });
          },
          "Frame of each pose: int64 of shape (N,); empty if it was read from a file.")
      .def("__repr__", [](const NumberedTrajectory& t) {
        return "<ldso.Trajectory of " + std::to_string(t.poses.size()) + " poses>";
      });
}

}  // namespace ldso::python
