#pragma once
// report.html: a finished run on one page that needs nothing but itself.

#include <filesystem>
#include <string>
#include <string_view>

#include "results/loop_pictures.h"
#include "results/run_report.h"

namespace ldso {

inline constexpr const char* kReportName = "report.html";

struct ReportInput {
  const RunSummary& summary;
  const Dataset& dataset;
  LoopPictures pictures;
  std::string_view map_script;  ///< The 3D view; empty if this program was built without.
  std::string written_at;       ///< Date and time, for people.
};

/// The whole page. It asks nobody for anything and runs no script but its own.
std::string report_html(const ReportInput& input);

/// Writes it, with pictures of some of the loops; the images are read once more for them.
/// Throws Error if it cannot be written.
void write_report(const std::filesystem::path& path, const RunSummary& summary, const Dataset& dataset);

}  // namespace ldso
