#pragma once
// The parts of report.html that are figures and tables: all of them HTML.

#include <string>

#include "results/run_report.h"

namespace ldso {

/// Last part of its path.
std::string sequence_name(const RunSummary& summary);

/// How the run ended.
std::string state_chip(const RunSummary& summary);

/// The few figures that one looks at first.
std::string key_figures(const RunSummary& summary);

/// Why the run ended early or has no pose; empty if it did neither.
std::string problem_box(const RunSummary& summary);

/// What the histogram of frame times says in figures.
std::string time_table(const RunSummary& summary);
std::string stage_table(const RunSummary& summary);

/// Frames without a pose and why, and all warnings.
std::string warning_lists(const RunSummary& summary);

/// The calibration, what became of it and the rectified camera.
std::string camera_tables(const RunSummary& summary, const Dataset& dataset);

/// Those that are not as they are by default, and all of them.
std::string settings_tables(const RunSummary& summary);

/// Which program made it.
std::string footer();

}  // namespace ldso
