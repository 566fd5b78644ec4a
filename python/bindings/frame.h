#pragma once

// A frame of a sequence as Python sees it.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <optional>
#include <string>

#include "bindings/arrays.h"
#include "ldso/raw_frame.h"

namespace ldso::python {

struct Frame {
  std::int64_t id = 0;
  double timestamp = 0;  ///< [s]
  std::optional<double> exposure_ms;
  std::string name;
  pybind11::array_t<float> image;
};

/// Takes the pixels without copying them.
inline Frame to_frame(RawFrame&& raw) {
  return {raw.id, raw.timestamp, raw.exposure_ms, std::move(raw.name), to_array(std::move(raw.grey))};
}

}  // namespace ldso::python
