#include "report/report_style.h"

#include <cstddef>

#include "util/embedded_file.h"

// LDSO_REPORT_DIR comes from CMakeLists.txt.
LDSO_EMBED_FILE(ldso_report_style, LDSO_REPORT_DIR "/report.css");

namespace ldso {

std::string_view report_style() {
  return {ldso_report_style_begin, static_cast<std::size_t>(ldso_report_style_end - ldso_report_style_begin)};
}

}  // namespace ldso
