#include "viewer/server/report_script.h"

#include <cstddef>

#include "util/embedded_file.h"

// LDSO_WEB_DIR comes from CMakeLists.txt.
LDSO_EMBED_FILE(ldso_report_script, LDSO_WEB_DIR "/report.js");

namespace ldso {

std::string_view report_script() {
  return {ldso_report_script_begin, static_cast<std::size_t>(ldso_report_script_end - ldso_report_script_begin)};
}

}  // namespace ldso
