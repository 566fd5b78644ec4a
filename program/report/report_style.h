#pragma once
// How report.html looks, by day and by night.

#include <string_view>

namespace ldso {

/// CSS.
std::string_view report_style();

}  // namespace ldso
