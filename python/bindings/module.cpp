// The Python module ldso._ldso; python/ldso/__init__.py shows it as ldso.

#include "bindings/bindings.h"

PYBIND11_MODULE(_ldso, module) {
  using namespace ldso::python;
  module.doc() = "Monocular direct visual SLAM.";
  module.attr("__version__") = LDSO_VERSION;
  bind_errors(module);
  bind_calibration(module);
  bind_settings(module);
  bind_trajectory(module);
  bind_records(module);
  bind_result(module);
  bind_slam(module);
  bind_dataset(module);
  bind_run(module);
  bind_evaluation(module);
  bind_simulation(module);
}
