#pragma once

// One function for each file of this room: what it adds to the module. Order matters where signatures name types.

#include <pybind11/pybind11.h>

namespace ldso::python {

void bind_errors(pybind11::module_& module);
void bind_calibration(pybind11::module_& module);
void bind_settings(pybind11::module_& module);
void bind_trajectory(pybind11::module_& module);
void bind_records(pybind11::module_& module);
void bind_result(pybind11::module_& module);
void bind_slam(pybind11::module_& module);
void bind_dataset(pybind11::module_& module);
void bind_run(pybind11::module_& module);
void bind_evaluation(pybind11::module_& module);
void bind_simulation(pybind11::module_& module);

}  // namespace ldso::python
