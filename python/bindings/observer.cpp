#include "bindings/observer.h"

#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <array>
#include <exception>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings/arrays.h"
#include "ldso/error.h"
#include "ldso/viewer.h"

namespace ldso::python {

namespace py = pybind11;
using py::literals::operator""_a;

namespace {

py::object pose_or_none(const std::optional<SE3d>& T) { return T ? py::object(to_array(*T)) : py::object(py::none()); }

/// A Python object that is kept, and let go of, on any thread.
class KeptObject {
 public:
  explicit KeptObject(py::object object) : object_(std::move(object)) {}
  ~KeptObject() {
    if (Py_IsInitialized() == 0) {
      object_.release();  // The interpreter has ended, and its objects with it.
      return;
    }
    const py::gil_scoped_acquire gil;
    object_ = py::object();
  }
  KeptObject(const KeptObject&) = delete;
  KeptObject& operator=(const KeptObject&) = delete;

  const py::object& get() const { return object_; }

  /// Calls it with what make() returns. Exceptions have nobody to go to: they are printed.
  template <class Make>
  void call(const char* method, Make make) const {
    const py::gil_scoped_acquire gil;
    try {
      const py::object called = method == nullptr ? object_ : py::object(object_.attr(method));
      called(*py::tuple(make()));
    } catch (py::error_already_set& error) {
      error.discard_as_unraisable(object_);
    } catch (const std::exception& error) {
      PyErr_SetString(PyExc_RuntimeError, error.what());
      PyErr_WriteUnraisable(object_.ptr());
    }
  }

 private:
  py::object object_;
};

py::array_t<double> points_of(const std::vector<MapPoint>& points) {
  return make_rows<double>(points.size(), 5, [&](std::size_t i, double* row) {
    const MapPoint& p = points[i];
    for (const double value : {p.u, p.v, p.idepth, p.idepth_stddev, p.intensity}) *row++ = value;
  });
}

py::dict to_dict(const FrameEvent& event) {
  return py::dict("frame"_a = event.frame, "is_late"_a = event.is_late,
                  "T_world_camera"_a = pose_or_none(event.T_world_camera), "exposure_ms"_a = event.exposure_ms,
                  "frame_ms"_a = event.frame_ms, "points"_a = event.points);
}

py::dict to_dict(const KeyframeUpdate& keyframe) {
  return py::dict("frame_id"_a = keyframe.frame_id, "segment"_a = keyframe.segment, "timestamp"_a = keyframe.timestamp,
                  "T_world_camera"_a = to_array(keyframe.T_world_camera), "camera"_a = keyframe.camera,
                  "points"_a = points_of(keyframe.points));
}

py::dict to_dict(const LoopEvent& event) {
  py::dict poses;
  for (const KeyframePose& pose : event.poses) poses[py::int_(pose.keyframe_id)] = to_array(pose.S_world_keyframe);
  return py::dict("accepted"_a = event.accepted, "poses"_a = poses, "correction"_a = to_array(event.correction),
                  "candidates"_a = event.candidates);
}

py::dict to_dict(const LiveView& view) {
  py::list window;
  for (const WindowKeyframe& keyframe : view.window) {
    window.append(py::dict("frame_id"_a = keyframe.frame_id, "T_world_camera"_a = to_array(keyframe.T_world_camera),
                           "points"_a = points_of(keyframe.points)));
  }
  const py::array_t<float> pixels = make_rows<float>(view.pixels.size(), 3, [&](std::size_t i, float* row) {
    const ViewPixel& p = view.pixels[i];
    row[0] = p.u, row[1] = p.v, row[2] = p.idepth;
  });
  return py::dict("frame_id"_a = view.frame_id, "camera"_a = view.camera,
                  "T_world_camera"_a = pose_or_none(view.T_world_camera), "window"_a = window, "pixels"_a = pixels,
                  "image"_a = to_array(view.image()));
}

class PythonObserver final : public RunObserver {
 public:
  explicit PythonObserver(py::object object) : object_(std::move(object)) {
    for (std::size_t i = 0; i < kMethods.size(); ++i) has_[i] = py::hasattr(object_.get(), kMethods[i]);
  }

  void on_start(const PinholeIntrinsics& camera) override { tell(0, camera); }
  void on_frame(FrameEvent event) override { tell_dict(1, event); }
  void on_keyframe(const KeyframeUpdate& keyframe, const PinholeIntrinsics&) override { tell_dict(2, keyframe); }
  void on_loops(LoopEvent event) override { tell_dict(3, event); }
  bool wants_view() override { return has_[4]; }
  void on_view(LiveView view) override { tell_dict(4, view); }

 private:
  static constexpr std::array<const char*, 5> kMethods{"on_start", "on_frame", "on_keyframe", "on_loops", "on_view"};

  template <class T>
  void tell(std::size_t method, const T& value) {
    if (has_[method]) object_.call(kMethods[method], [&] { return py::make_tuple(value); });
  }
  template <class T>
  void tell_dict(std::size_t method, const T& value) {
    if (has_[method]) object_.call(kMethods[method], [&] { return py::make_tuple(to_dict(value)); });
  }

  KeptObject object_;
  std::array<bool, kMethods.size()> has_{};
};

}  // namespace

std::shared_ptr<RunObserver> to_observer(const py::object& object) {
  if (object.is_none()) return nullptr;
  if (py::isinstance<Viewer>(object)) return object.cast<const Viewer&>().observer();
  return std::make_shared<PythonObserver>(object);
}

LogSink to_log(const py::object& function) {
  if (function.is_none()) return {};
  const auto kept = std::make_shared<KeptObject>(function);
  return [kept](LogLevel level, const std::string& text) {
    kept->call(nullptr, [&] { return py::make_tuple(level == LogLevel::kWarning, text); });
  };
}

}  // namespace ldso::python
