// Slam: images one by one.

#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/observer.h"
#include "bindings/settings.h"
#include "ldso/error.h"
#include "ldso/slam.h"
#include "ldso/viewer.h"

namespace ldso::python {

namespace py = pybind11;
using py::literals::operator""_a;

namespace {

/// A Slam whose threads may call Python: nothing waits for them while it holds the interpreter's lock.
class PythonSlam {
 public:
  PythonSlam(const Calibration& calibration, const py::object& settings, const py::object& log,
             const py::object& observer) {
    const Settings all = to_settings(settings);
    LogSink sink = to_log(log);
    std::shared_ptr<RunObserver> watcher = to_observer(observer);
    const py::gil_scoped_release no_gil;
    slam_ = std::make_unique<Slam>(calibration, all, std::move(sink), std::move(watcher));
  }
  ~PythonSlam() {
    const py::gil_scoped_release no_gil;
    slam_.reset();
  }
  PythonSlam(const PythonSlam&) = delete;
  PythonSlam& operator=(const PythonSlam&) = delete;

  FrameRecord process(const py::object& image, double timestamp, std::optional<double> exposure_ms) {
    const ImageArgument argument(image);  // Keeps the pixels while they are read.
    const py::gil_scoped_release no_gil;
    return std::visit([&](const auto& view) { return slam_->process(view, timestamp, exposure_ms); }, argument.view());
  }

  std::optional<SE3d> T_world_camera() const { return slam_->T_world_camera(); }
  PinholeIntrinsics rectified_camera() const { return slam_->rectified_camera(); }
  SlamResult snapshot() const {
    const py::gil_scoped_release no_gil;
    return slam_->snapshot();
  }
  SlamResult finish() {
    const py::gil_scoped_release no_gil;
    return slam_->finish();
  }

 private:
  std::unique_ptr<Slam> slam_;
};

void bind_viewer(py::module_& module) {
  py::class_<Viewer>(module, "Viewer", "A page on which a run is watched: pass it as `observer`.")
      .def(py::init([](const std::string& address, const std::string& name) {
             return std::make_unique<Viewer>(ViewerOptions{address, name});
           }),
           "address"_a = "", "name"_a = "",
           "address: \"ADDRESS:PORT\"; empty: this machine alone, a port that is free.")
      .def_property_readonly("url", &Viewer::url, "What a browser is to be given.")
      .def("finish", &Viewer::finish, "Tell the page that the run is over.");
}

}  // namespace

void bind_slam(py::module_& module) {
  bind_viewer(module);
  py::class_<PythonSlam>(module, "Slam",
                         "Monocular direct SLAM, one image at a time. The same images and settings give the same bits. "
                         "The interpreter's lock is released while it works.")
      .def(py::init<const Calibration&, const py::object&, const py::object&, const py::object&>(), "calibration"_a,
           "settings"_a = py::none(), py::kw_only(), "log"_a = py::none(), "observer"_a = py::none(),
           "settings: ldso.Settings or a dict. log(is_warning, text) hears of losses, restarts and a calibration that "
           "the images contradict. observer: an ldso.Viewer, or an object with some of the methods on_start(camera), "
           "on_frame(event), on_keyframe(keyframe), on_loops(event) and on_view(view); each is given a dict (docs/"
           "python.md). Both may be called on other threads.")
      .def(
          "process", &PythonSlam::process, "image"_a, "timestamp"_a, "exposure_ms"_a = py::none(),
          "Track one grey image as the camera took it: shape (height, width), uint8, uint16 (full range) or float32 "
          "(grey levels 0..255). An image whose rows are of one piece is not copied. timestamp in seconds. Returns its "
          "FrameRecord.")
      .def_property_readonly(
          "T_world_camera",
          [](const PythonSlam& s) -> py::object {
            const auto T = s.T_world_camera();
            return T ? py::object(to_array(*T)) : py::object(py::none());
          },
          "Pose of the newest frame as now estimated: (4, 4), camera to world; None while it is not tracked.")
      .def_property_readonly("rectified_camera", &PythonSlam::rectified_camera)
      .def("snapshot", &PythonSlam::snapshot, "The SlamResult so far; the run goes on.")
      .def("finish", &PythonSlam::finish, "End the run. No image can follow.");
}

}  // namespace ldso::python
