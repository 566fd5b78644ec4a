#pragma once

// The 3D view of report.html, which the build put into the program.

#include <string_view>

namespace ldso {

/// JavaScript for the inside of a <script> element: it shows the recording that it finds in the page. Empty if this
/// program was built without its viewer.
std::string_view report_script();

}  // namespace ldso
