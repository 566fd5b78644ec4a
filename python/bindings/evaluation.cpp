// Trajectories against ground truth.

#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/trajectory.h"
#include "evaluation/report.h"
#include "evaluation/trajectory_evaluation.h"

namespace ldso::python {

namespace py = pybind11;
using py::literals::operator""_a;

namespace {

EvaluationResult evaluate_given(const py::object& estimate, const py::object& truth, const std::string& align,
                                double max_time_difference, bool pair_by_index, int delta, bool all_pairs) {
  EvaluationOptions options;
  options.alignment = parse_alignment_mode(align);
  options.max_time_difference = max_time_difference;
  options.pair_by_index = pair_by_index;
  options.relative = {delta, all_pairs};
  return evaluate_trajectory(to_trajectory(estimate), to_trajectory(truth), options);
}

py::object figures_dict(const EvaluationResult& result) {
  return py::module_::import("json").attr("loads")(result_json(result));
}

void bind_statistics(py::module_& module) {
  py::class_<Statistics>(module, "Statistics", "Six figures that sum up a list of errors.")
      .def_readonly("count", &Statistics::count)
      .def_readonly("rmse", &Statistics::rmse)
      .def_readonly("mean", &Statistics::mean)
      .def_readonly("median", &Statistics::median)
      .def_readonly("stddev", &Statistics::stddev)
      .def_readonly("min", &Statistics::min)
      .def_readonly("max", &Statistics::max)
      .def("__repr__", [](const Statistics& s) {
        return py::str("Statistics(rmse={:.6g}, median={:.6g}, max={:.6g}, count={})")
            .format(s.rmse, s.median, s.max, s.count);
      });
}

void bind_tum_mono(py::module_& module) {
  py::class_<TumMonoError>(module, "TumMonoError",
                           "Errors of the TUM-mono benchmark, from ground truth at both ends of a sequence.")
      .def_readonly("e_align", &TumMonoError::e_align, "[unit of the ground truth]")
      .def_readonly("e_rmse", &TumMonoError::e_rmse, "[unit of the ground truth]")
      .def_readonly("e_translation", &TumMonoError::e_translation, "[unit of the ground truth]")
      .def_readonly("e_rotation_deg", &TumMonoError::e_rotation_deg)
      .def_readonly("e_scale", &TumMonoError::e_scale);
}

}  // namespace

void bind_evaluation(py::module_& module) {
  bind_statistics(module);
  bind_tum_mono(module);
  py::class_<EvaluationResult>(module, "Evaluation", "An estimate against the ground truth; lengths in its unit.")
      .def_readonly("ate", &EvaluationResult::absolute, "Absolute trajectory error.")
      .def_readonly("rpe_translation", &EvaluationResult::relative_translation, "Relative error, or None.")
      .def_readonly("rpe_rotation_deg", &EvaluationResult::relative_rotation_deg, "[deg], or None.")
      .def_readonly("tum_mono", &EvaluationResult::tum_mono,
                    "If the ground truth has a start and an end alone and the estimate reaches both; else None.")
      .def_readonly("path_length", &EvaluationResult::path_length, "Of the ground truth.")
      .def_property_readonly("ate_percent_of_path", &EvaluationResult::ate_percent_of_path)
      .def_property_readonly(
          "errors",
          [](const EvaluationResult& r) {
            return make_column<double>(r.absolute_errors.size(), [&](std::size_t i) { return r.absolute_errors[i]; });
          },
          "Of each pair of poses: float64 of shape (N,).")
      .def_property_readonly(
          "pairs",
          [](const EvaluationResult& r) {
            return make_rows<std::int64_t>(r.pairs.size(), 2, [&](std::size_t i, std::int64_t* row) {
              row[0] = static_cast<std::int64_t>(r.pairs[i].estimate);
              row[1] = static_cast<std::int64_t>(r.pairs[i].truth);
            });
          },
          "Which pose of the estimate was compared with which of the truth: int64 of shape (N, 2).")
      .def_property_readonly(
          "S_truth_estimate", [](const EvaluationResult& r) { return to_array(r.S_truth_estimate); },
          "Similarity that maps the estimate's world to that of the truth: (4, 4).")
      .def("to_dict", &figures_dict, "All figures, by the names of `ldso eval --json`.")
      .def("__str__", [](const EvaluationResult& r) { return result_table(r); });
  module.def(
      "evaluate", &evaluate_given, "estimate"_a, "truth"_a, py::kw_only(), "align"_a = "sim3",
      "max_time_difference"_a = EvaluationOptions().max_time_difference, "pair_by_index"_a = false, "delta"_a = 1,
      "all_pairs"_a = false,
      "Compare two trajectories: each an ldso.Trajectory, rows of shape (N, 8) as of a TUM file, or the path of a "
      "file or a sequence. align: sim3, se3, scale or none; delta: length of the motions of the relative error "
      "[poses]. Returns an Evaluation.");
}

}  // namespace ldso::python
