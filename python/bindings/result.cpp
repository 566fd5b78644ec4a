// SlamResult: trajectories and points of a run as arrays.

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/trajectory.h"
#include "ldso/io/result_files.h"
#include "ldso/slam.h"

namespace ldso::python {

namespace py = pybind11;
using py::literals::operator""_a;

namespace {

struct PointCloud {
  std::vector<WorldPoint> points;
};

Correction which_poses(bool corrected) { return corrected ? Correction::kLoops : Correction::kNone; }

void bind_points(py::module_& module) {
  py::class_<PointCloud>(module, "PointCloud", "Points of a map in its world.")
      .def("__len__", [](const PointCloud& p) { return p.points.size(); })
      .def_property_readonly(
          "xyz",
          [](const PointCloud& p) {
            return make_rows<double>(p.points.size(), 3, [&](std::size_t i, double* row) {
              for (int k = 0; k < 3; ++k) row[k] = p.points[i].position[k];
            });
          },
          "float64 of shape (N, 3) [map units].")
      .def_property_readonly(
          "intensity",
          [](const PointCloud& p) {
            return make_column<float>(p.points.size(), [&](std::size_t i) { return p.points[i].intensity; });
          },
          "Irradiance 0..255: float32 of shape (N,).")
      .def_property_readonly(
          "idepth_stddev",
          [](const PointCloud& p) {
            return make_column<float>(p.points.size(), [&](std::size_t i) { return p.points[i].idepth_stddev; });
          },
          "Standard deviation of the inverse depth in the host keyframe [1 / map unit]: float32 of shape (N,).")
      .def_property_readonly(
          "keyframe_ids",
          [](const PointCloud& p) {
            return make_column<std::int64_t>(p.points.size(), [&](std::size_t i) { return p.points[i].keyframe_id; });
          },
          "Host keyframes: int64 of shape (N,).")
      .def_property_readonly(
          "pixels",
          [](const PointCloud& p) {
            return make_rows<float>(p.points.size(), 2, [&](std::size_t i, float* row) {
              row[0] = p.points[i].pixel.x(), row[1] = p.points[i].pixel.y();
            });
          },
          "Where the hosts see them, in the rectified image [px]: float32 of shape (N, 2).")
      .def(
          "write_ply",
          [](const PointCloud& p, const std::filesystem::path& path) { write_ply(path, to_cloud(p.points)); }, "path"_a,
          "Binary PLY: x y z, colours, intensity, idepth_stddev.")
      .def("__repr__",
           [](const PointCloud& p) { return "<ldso.PointCloud of " + std::to_string(p.points.size()) + " points>"; });
}

py::dict stage_times(const SlamResult& result) {
  py::dict dict;
  for (const auto& [stage, time] : result.stage_times) {
    dict[py::str(stage)] = py::dict("calls"_a = time.calls, "total_ms"_a = time.total_ms, "worst_ms"_a = time.worst_ms);
  }
  return dict;
}

void add_geometry(py::class_<SlamResult>& type) {
  type.def(
          "trajectory",
          [](const SlamResult& r, bool corrected, int part) {
            return to_numbered(r.trajectory(which_poses(corrected), part));
          },
          "corrected"_a = true, "part"_a = 0,
          "Poses of all frames that have one; corrected: after loop closing. A part is a map that shares no "
          "coordinates "
          "with the others.")
      .def(
          "keyframe_trajectory",
          [](const SlamResult& r, bool corrected, int part) {
            return to_numbered(r.keyframe_trajectory(which_poses(corrected), part));
          },
          "corrected"_a = true, "part"_a = 0, "Poses of the keyframes.")
      .def(
          "points",
          [](const SlamResult& r, bool corrected, int part) {
            return PointCloud{r.points(which_poses(corrected), part)};
          },
          "corrected"_a = true, "part"_a = 0, "The points of the map.")
      .def(
          "write_colmap",
          [](const SlamResult& r, const std::filesystem::path& folder) {
            write_colmap_model(folder, to_colmap_model(r.camera, r.keyframe_trajectory(), r.points()));
          },
          "folder"_a, "cameras.txt, images.txt and points3D.txt of the keyframes, whose images are called 000123.png.");
}

}  // namespace

void bind_result(py::module_& module) {
  bind_points(module);
  py::class_<SlamResult> type(module, "SlamResult",
                              "What a run has found. Poses and points have the free scale of a single camera.");
  add_geometry(type);
  type.def_property_readonly("parts", [](const SlamResult& r) { return r.parts(); })
      .def_readonly("frames", &SlamResult::frames, "FrameRecords of all frames, in the order in which they came.")
      .def_readonly("loops", &SlamResult::loops, "LoopRecords of all pairs that looked alike, accepted or refused.")
      .def_readonly("camera", &SlamResult::camera, "Of the rectified images, as estimated.")
      .def_readonly("better_calibration", &SlamResult::better_calibration,
                    "A Calibration with which the images are explained better, if they contradict the given one; or "
                    "None. Begin the next run with it, or let ldso.run() do so.")
      .def_readonly("initializations", &SlamResult::initializations, "Frames with which a map was there.")
      .def_readonly("restarts", &SlamResult::restarts, "How often the map was lost and a new one begun.")
      .def_readonly("skipped", &SlamResult::skipped, "Frames that could not be used.")
      .def_property_readonly("stage_times", &stage_times, "calls, total_ms and worst_ms of each stage.")
      .def("__repr__", [](const SlamResult& r) {
        return "<ldso.SlamResult: " + std::to_string(r.frames.size()) + " frames, " +
               std::to_string(r.keyframes.size()) + " keyframes>";
      });
}

}  // namespace ldso::python
