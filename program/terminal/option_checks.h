#pragma once
// What the values of options may be. Those of the library name the range of a double in 309 digits.

#include <CLI/CLI.hpp>

namespace ldso {

/// A number above zero.
CLI::Validator positive_number();

/// A number that is zero or more.
CLI::Validator number_from_zero();

/// A frame rate above zero, perhaps as a fraction: "30000/1001" becomes a number.
CLI::Validator frame_rate();

}  // namespace ldso
