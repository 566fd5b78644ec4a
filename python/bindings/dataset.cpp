// Sequences on disk: opened, indexed, and iterated with the next frames being decoded meanwhile.

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings/bindings.h"
#include "bindings/frame.h"
#include "bindings/trajectory.h"
#include "ldso/error.h"
#include "ldso/io/dataset.h"
#include "util/prefetching_reader.h"

namespace ldso::python {

namespace py = pybind11;
using py::literals::operator""_a;

namespace {

/// Read from one thread at a time, whoever iterates and indexes at once.
class SerialDataset final : public Dataset {
 public:
  explicit SerialDataset(std::unique_ptr<Dataset> dataset) : dataset_(std::move(dataset)) {}

  int size() const override { return dataset_->size(); }
  double timestamp(int index) const override { return dataset_->timestamp(index); }
  const Calibration& calibration() const override { return dataset_->calibration(); }
  std::optional<Trajectory> ground_truth() const override { return dataset_->ground_truth(); }
  std::string format_name() const override { return dataset_->format_name(); }
  const std::vector<std::string>& warnings() const override { return dataset_->warnings(); }
  RawFrame read(int index) const override {
    const std::lock_guard lock(mutex_);
    return dataset_->read(index);
  }

 private:
  std::unique_ptr<Dataset> dataset_;
  mutable std::mutex mutex_;
};

std::shared_ptr<Dataset> open_sequence_at(const std::filesystem::path& path, int start, std::optional<int> end,
                                          int stride, bool reverse,
                                          const std::optional<std::filesystem::path>& calibration,
                                          std::optional<double> fps, const std::string& pattern,
                                          const std::string& topic) {
  const py::gil_scoped_release no_gil;  // A video is looked through.
  return std::make_shared<SerialDataset>(open_dataset(path, {.start = start,
                                                             .end = end,
                                                             .stride = stride,
                                                             .reverse = reverse,
                                                             .calibration_file = calibration,
                                                             .fps = fps,
                                                             .pattern = pattern,
                                                             .topic = topic}));
}

int checked_index(const Dataset& dataset, int index) {
  if (index < 0) index += dataset.size();
  if (index < 0 || index >= dataset.size()) throw py::index_error("frame " + std::to_string(index));
  return index;
}

Frame read_frame(const Dataset& dataset, int index) {
  index = checked_index(dataset, index);
  std::optional<RawFrame> raw;
  {
    const py::gil_scoped_release no_gil;
    raw = dataset.read(index);
  }
  return to_frame(std::move(*raw));
}

/// One way through the frames. Those that cannot be read raise; the next ones can be asked for.
class FrameIterator {
 public:
  explicit FrameIterator(std::shared_ptr<const Dataset> dataset)
      : dataset_(std::move(dataset)), reader_(std::in_place, dataset_->size(), [dataset = dataset_.get()](int index) {
          return dataset->read(index);
        }) {}
  ~FrameIterator() {
    const py::gil_scoped_release no_gil;
    reader_.reset();
  }
  FrameIterator(const FrameIterator&) = delete;
  FrameIterator& operator=(const FrameIterator&) = delete;

  Frame next() {
    std::optional<PrefetchingReader<RawFrame>::Item> item;
    {
      const py::gil_scoped_release no_gil;
      item = reader_->next();
    }
    if (!item) throw py::stop_iteration();
    if (!item->value) throw Error("frame " + std::to_string(item->index), item->error, "");
    return to_frame(std::move(*item->value));
  }

 private:
  std::shared_ptr<const Dataset> dataset_;
  std::optional<PrefetchingReader<RawFrame>> reader_;
};

py::object dataset_truth(const Dataset& dataset) {
  auto truth = dataset.ground_truth();
  return truth ? py::cast(NumberedTrajectory{std::move(*truth), {}}) : py::none();
}

void bind_dataset_frame(py::module_& module) {
  py::class_<Frame>(module, "Frame", "An image of a sequence.")
      .def_readonly("id", &Frame::id, "Index in the sequence as it is played.")
      .def_readonly("timestamp", &Frame::timestamp, "[s]")
      .def_readonly("exposure_ms", &Frame::exposure_ms, "None if unknown.")
      .def_readonly("name", &Frame::name, "The file that it came from.")
      .def_readonly("image", &Frame::image, "Grey levels 0..255: float32 of shape (height, width).")
      .def("__repr__", [](const Frame& f) { return "<ldso.Frame " + std::to_string(f.id) + ">"; });
}

}  // namespace

void bind_dataset(py::module_& module) {
  bind_dataset_frame(module);
  py::class_<FrameIterator>(module, "FrameIterator")
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__", &FrameIterator::next);
  py::class_<Dataset, std::shared_ptr<Dataset>>(
      module, "Dataset", "A sequence with its calibration: len(), [index], and iteration, which decodes ahead.")
      .def("__len__", &Dataset::size)
      .def("__getitem__", &read_frame)
      .def("__iter__", [](std::shared_ptr<Dataset> d) { return std::make_unique<FrameIterator>(std::move(d)); })
      .def(
          "timestamp", [](const Dataset& d, int index) { return d.timestamp(checked_index(d, index)); }, "index"_a,
          "[s]")
      .def_property_readonly("calibration", [](const Dataset& d) { return d.calibration(); })
      .def_property_readonly("ground_truth", &dataset_truth, "Its Trajectory, or None.")
      .def_property_readonly("format", &Dataset::format_name)
      .def_property_readonly("warnings", &Dataset::warnings, "What was odd about it: a list of str.")
      .def("__repr__", [](const Dataset& d) {
        return "<ldso.Dataset " + d.format_name() + ", " + std::to_string(d.size()) + " frames>";
      });
  module.def("open", &open_sequence_at, "path"_a, py::kw_only(), "start"_a = 0, "end"_a = py::none(), "stride"_a = 1,
             "reverse"_a = false, "calibration"_a = py::none(), "fps"_a = py::none(), "pattern"_a = "", "topic"_a = "",
             "Open a sequence whose format is recognized: TUM-mono, KITTI, EuRoC, TUM RGB-D, a folder of images, a "
             "video, a ROS bag. The options are those of `ldso run`; calibration is the path of a file.");
}

}  // namespace ldso::python
