#pragma once

// A Python object that is told what goes on in a run.

#include <pybind11/pybind11.h>

#include <memory>

#include "ldso/log.h"
#include "ldso/observer.h"

namespace ldso::python {

/// Calls those of on_start, on_frame, on_keyframe, on_loops and on_view that the object has. What they raise is printed
/// and changes nothing. None: no observer. An ldso.Viewer: its own.
std::shared_ptr<RunObserver> to_observer(const pybind11::object& object);

/// Calls log(is_warning, text), from any thread. None: nobody hears.
LogSink to_log(const pybind11::object& function);

}  // namespace ldso::python
