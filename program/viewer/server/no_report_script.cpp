#include "viewer/server/report_script.h"

// Of a program that was built without its viewer.

namespace ldso {

std::string_view report_script() { return {}; }

}  // namespace ldso
