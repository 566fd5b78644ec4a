// What a run says of frames and loops.

#include <pybind11/stl.h>

#include <string>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "ldso/records.h"
#include "ldso/slam.h"

namespace ldso::python {

namespace py = pybind11;

namespace {

std::string state_word(TrackingState state) {
  switch (state) {
    case TrackingState::kInitializing:
      return "initializing";
    case TrackingState::kTracked:
      return "tracked";
    default:
      return "lost";
  }
}

void bind_frame(py::module_& module) {
  py::class_<FrameRecord>(module, "FrameRecord", "What is said of a frame.")
      .def_readonly("frame_id", &FrameRecord::frame_id)
      .def_readonly("timestamp", &FrameRecord::timestamp, "[s]")
      .def_property_readonly(
          "state", [](const FrameRecord& f) { return state_word(f.state); }, "initializing, tracked or lost.")
      .def_property_readonly("is_tracked", [](const FrameRecord& f) { return f.state == TrackingState::kTracked; })
      .def_readonly("reason", &FrameRecord::reason, "Why there is no pose, or empty.")
      .def_readonly("is_keyframe", &FrameRecord::is_keyframe)
      .def_readonly("keyframe_id", &FrameRecord::keyframe_id, "frame_id of its reference keyframe, or -1.")
      .def_property_readonly(
          "T_keyframe_frame", [](const FrameRecord& f) { return to_array(f.T_keyframe_frame); },
          "Maps points of this frame to the reference keyframe: (4, 4).")
      .def_readonly("residual_rmse", &FrameRecord::residual_rmse, "Of its alignment [grey levels].")
      .def_readonly("brightness_a", &FrameRecord::brightness_a, "Log of the brightness factor.")
      .def_readonly("brightness_b", &FrameRecord::brightness_b, "Brightness offset [grey levels].")
      .def("__repr__", [](const FrameRecord& f) {
        return "<ldso.FrameRecord " + std::to_string(f.frame_id) + " " + state_word(f.state) +
               (f.reason.empty() ? "" : ": " + f.reason) + ">";
      });
}

void bind_loop(py::module_& module) {
  py::class_<LoopRecord>(module, "LoopRecord", "A pair of keyframes that looked like one place, and what came of it.")
      .def_readonly("keyframe_id", &LoopRecord::keyframe_id, "The later keyframe (its frame_id).")
      .def_readonly("candidate_id", &LoopRecord::candidate_id, "The earlier one.")
      .def_readonly("accepted", &LoopRecord::accepted)
      .def_readonly("reason", &LoopRecord::reason, "Why it was refused, or empty.")
      .def_readonly("score", &LoopRecord::score, "Of place recognition, 0..1.")
      .def_readonly("inliers", &LoopRecord::inliers)
      .def_property_readonly(
          "S_keyframe_candidate", [](const LoopRecord& l) { return to_array(l.S_keyframe_candidate); },
          "Similarity that maps points of the candidate to the keyframe: (4, 4).")
      .def_property_readonly(
          "matches",
          [](const LoopRecord& l) {
            return make_rows<float>(l.matches.size(), 4, [&](std::size_t i, float* row) {
              const LoopMatchPixels& m = l.matches[i];
              for (const float value : {m.u_candidate, m.v_candidate, m.u, m.v}) *row++ = value;
            });
          },
          "Pixels of the inliers of an accepted loop: float32 of shape (N, 4), u v in the candidate, u v in the "
          "keyframe.")
      .def("__repr__", [](const LoopRecord& l) {
        return "<ldso.LoopRecord " + std::to_string(l.keyframe_id) + " -> " + std::to_string(l.candidate_id) +
               (l.accepted ? ">" : ": " + l.reason + ">");
      });
}

}  // namespace

void bind_records(py::module_& module) {
  bind_frame(module);
  bind_loop(module);
}

}  // namespace ldso::python
