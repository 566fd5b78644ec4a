// run(): what `ldso run` does.

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <atomic>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/observer.h"
#include "bindings/observer_pair.h"
#include "bindings/settings.h"
#include "image/grey_levels.h"
#include "ldso/error.h"
#include "ldso/io/dataset.h"
#include "ldso/results_folder.h"
#include "ldso/sequence_run.h"

namespace ldso::python {

namespace py = pybind11;
namespace fs = std::filesystem;
using py::literals::operator""_a;

namespace {

/// Images that a program keeps: a Python sequence of (image, timestamp) or (image, timestamp, exposure_ms).
class ImageSequence final : public Dataset {
 public:
  ImageSequence(py::object images, Calibration calibration)
      : images_(std::move(images)), calibration_(std::move(calibration)), size_(static_cast<int>(py::len(images_))) {}
  ~ImageSequence() override {
    const py::gil_scoped_acquire gil;
    images_ = py::object();
  }

  int size() const override { return size_; }
  const Calibration& calibration() const override { return calibration_; }
  std::optional<Trajectory> ground_truth() const override { return std::nullopt; }
  std::string format_name() const override { return "images of a program"; }
  const std::vector<std::string>& warnings() const override { return warnings_; }

  double timestamp(int index) const override {
    const py::gil_scoped_acquire gil;
    return item(index)[1].cast<double>();
  }

  RawFrame read(int index) const override {
    const py::gil_scoped_acquire gil;
    try {
      return make(index, item(index));
    } catch (const py::error_already_set& error) {
      throw Error("image " + std::to_string(index), error.what(), "mend what yields it");
    } catch (const py::cast_error&) {
      throw Error("image " + std::to_string(index), "its time or exposure is no number",
                  "give seconds and milliseconds");
    }
  }

 private:
  py::tuple item(int index) const {
    const py::tuple parts(images_[py::int_(index)]);
    if (parts.size() == 2 || parts.size() == 3) return parts;
    throw Error("image " + std::to_string(index), "it has " + std::to_string(parts.size()) + " parts",
                "give (image, timestamp) or (image, timestamp, exposure_ms)");
  }

  static RawFrame make(int index, const py::tuple& item) {
    RawFrame frame;
    frame.id = index;
    frame.name = "image " + std::to_string(index);
    frame.timestamp = item[1].cast<double>();
    if (item.size() == 3) frame.exposure_ms = item[2].cast<std::optional<double>>();
    const ImageArgument image(item[0]);
    frame.grey = std::visit([](const auto& view) { return to_grey(view); }, image.view());
    return frame;
  }

  py::object images_;
  Calibration calibration_;
  std::vector<std::string> warnings_;
  int size_;
};

/// Tells Python how far the run is, and stops it once that raises or Ctrl-C was pressed.
class Progress {
 public:
  explicit Progress(py::object function) : function_(std::move(function)) {}

  void operator()(const RunProgress& progress) {
    const py::gil_scoped_acquire gil;
    if (raised_) return;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!function_.is_none()) function_(progress.done, progress.count);
    } catch (py::error_already_set&) {
      raised_ = std::current_exception();
      stop_ = true;
    }
  }

  const std::atomic<bool>* stop() const { return &stop_; }
  /// With the interpreter's lock.
  void rethrow() const {
    if (raised_) std::rethrow_exception(raised_);
  }

 private:
  py::object function_;
  std::exception_ptr raised_;
  std::atomic<bool> stop_{false};
};

struct Input {
  std::shared_ptr<Dataset> dataset;
  fs::path path;  ///< Empty: its images are not files.
  DatasetOptions options;
};

DatasetOptions options_from(py::dict& given) {
  DatasetOptions options;
  const auto take = [&](const char* name, auto& to) {
    if (!given.contains(name)) return;
    to = given[name].cast<std::remove_reference_t<decltype(to)>>();
    given.attr("pop")(name);
  };
  take("start", options.start);
  take("end", options.end);
  take("stride", options.stride);
  take("reverse", options.reverse);
  take("fps", options.fps);
  take("pattern", options.pattern);
  take("topic", options.topic);
  return options;
}

Input open_input(const py::object& source, const py::object& calibration, py::dict& more) {
  Input input;
  if (py::isinstance<Dataset>(source)) {
    input.dataset = source.cast<std::shared_ptr<Dataset>>();
    return input;
  }
  if (!py::isinstance<py::str>(source) && !py::hasattr(source, "__fspath__")) {
    if (!py::isinstance<Calibration>(calibration))
      throw Error("run", "images without a calibration", "pass calibration=ldso.Calibration(...)");
    input.dataset = std::make_shared<ImageSequence>(source, calibration.cast<Calibration>());
    return input;
  }
  input.path = source.cast<fs::path>();
  input.options = options_from(more);
  if (py::isinstance<Calibration>(calibration))
    throw Error("run", "a sequence on disk takes its calibration from a file",
                "write it by Calibration.write() and pass the path");
  if (!calibration.is_none()) input.options.calibration_file = calibration.cast<fs::path>();
  const py::gil_scoped_release no_gil;
  input.dataset = open_dataset(input.path, input.options);
  return input;
}

SequenceRun run_source(const py::object& source, const std::optional<fs::path>& out, const py::object& calibration,
                       const py::object& settings, const py::object& progress, const py::object& log,
                       const py::object& observer, bool report, bool loop_pictures, const py::kwargs& kwargs) {
  py::dict more(kwargs.attr("copy")());
  const Input input = open_input(source, calibration, more);
  Settings all = to_settings(settings);
  update_settings(all, more, "");
  all.validate();
  LogSink sink = to_log(log);
  for (const std::string& warning : input.dataset->warnings())
    if (sink) sink(LogLevel::kWarning, warning);
  Progress teller(progress);
  RunOptions options;
  options.progress = [&](const RunProgress& now) { teller(now); };
  options.stop = teller.stop();
  options.observer = to_observer(observer);
  SequenceRun done;
  {
    const py::gil_scoped_release no_gil;
    std::optional<ResultsFolder> results;
    if (out) {
      ResultsFolderOptions folder{"", sink, input.path, input.options, false, loop_pictures, report};
      results.emplace(*out, *input.dataset, all, folder);
      options.observer = observe_both(results->observer(), options.observer);
      sink = results->log();
    }
    done = run_sequence(*input.dataset, all, sink, options);
    if (results) results->write(done);
  }
  teller.rethrow();
  if (!done.error.empty()) {
    throw Error(input.path.empty() ? "run" : input.path.string(), "the run ended early: " + done.error,
                out ? "the frames up to there are saved in " + out->string() : "");
  }
  return done;
}

}  // namespace

void bind_found_camera(py::module_& module) {
  py::class_<FoundCamera>(module, "FoundCamera",
                          "How well the camera is known of a sequence that came without a calibration.")
      .def_property_readonly(
          "stddevs",
          [](const FoundCamera& f) {
            return make_column<double>(f.stddevs.size(), [&](std::size_t i) { return f.stddevs[i]; });
          },
          "Standard deviations of fx, fy, cx, cy [px], the first two distortion coefficients and the readout [ms]: "
          "float64 of shape (7,).")
      .def_readonly("doubt", &FoundCamera::doubt, "Why it is not known; empty if it is.")
      .def("__repr__", [](const FoundCamera& f) {
        return f.doubt.empty() ? std::string("<ldso.FoundCamera>") : "<ldso.FoundCamera, in doubt: " + f.doubt + ">";
      });
}

void bind_run(py::module_& module) {
  bind_found_camera(module);
  py::class_<SequenceRun>(module, "SequenceRun", "What ldso.run() has done.")
      .def_readonly("result", &SequenceRun::result)
      .def_readonly("calibration", &SequenceRun::calibration, "With which the frames were read in the end.")
      .def_readonly("passes", &SequenceRun::passes, "How often the sequence was begun.")
      .def_readonly("is_corrected", &SequenceRun::is_corrected, "Whether the calibration is a better one.")
      .def_readonly("proof", &SequenceRun::proof, "What speaks for it.")
      .def_readonly("refused_correction", &SequenceRun::refused_correction, "One that did not prove itself, and why.")
      .def_readonly(
          "found_camera", &SequenceRun::found_camera,
          "A FoundCamera if the sequence came without a calibration, else None: `calibration` is then the one that "
          "was found.")
      .def_readonly("seconds", &SequenceRun::seconds, "Wall time of all frames.")
      .def("__repr__", [](const SequenceRun& r) {
        return "<ldso.SequenceRun of " + std::to_string(r.result.frames.size()) + " frames>";
      });
  module.def(
      "run", &run_source, "source"_a, "out"_a = py::none(), py::kw_only(), "calibration"_a = py::none(),
      "settings"_a = py::none(), "progress"_a = py::none(), "log"_a = py::none(), "observer"_a = py::none(),
      "report"_a = true, "loop_pictures"_a = false,
      "Track the camera through a whole sequence and begin anew with a better calibration where there is one, as `ldso "
      "run` does. source: the path of a sequence, an ldso.Dataset, or anything with len() and [index] that gives "
      "(image, "
      "timestamp) or (image, timestamp, exposure_ms); that needs a Calibration. out: a folder for the results, with "
      "all "
      "files of `ldso run -o`. calibration: the path of one that is used instead of the sequence's. progress(done, "
      "count) is called after each frame; what it raises ends the run, and what there is is saved. log and observer: "
      "as "
      "of Slam. Further keywords: start, end, stride, reverse, fps, pattern, topic of a path, and settings (threads=1, "
      "loops={\"enabled\": False}). Returns a SequenceRun.");
}

}  // namespace ldso::python
