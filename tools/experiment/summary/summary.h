#pragma once
// All figures and tables of an experiment, from what is finished.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiment/summary/cumulative_plot.h"

namespace ldso {

struct SummaryOptions {
  std::filesystem::path experiment;                ///< The folder that holds jobs/.
  std::filesystem::path output;                    ///< Created. Files in it that have the names of ours are replaced.
  std::optional<std::filesystem::path> published;  ///< Instead of the built-in published figures.
  CumulativePlotOptions curves;
  bool trajectories = true;  ///< Also draw trajectories: the part that takes the time.
  int threads = 1;
  /// Turns an SVG file into a PNG file beside it; false if it could not. Without: no PNG files. Called from several
  /// threads.
  std::function<bool(const std::filesystem::path& svg, const std::filesystem::path& png)> make_png;
};

struct SummaryReport {
  std::size_t finished = 0, failed = 0, pending = 0;
  std::size_t figures = 0, tables = 0;
  std::vector<std::string> warnings;
  std::string overview;  ///< The summaries of all data sets as text tables.
};

/// Writes into `output`: index.html, summary.md, results.csv, results.json, figures/*.svg, tables/*.{csv,md,tex}. Runs
/// may go on meanwhile. Throws ldso::Error if there are no jobs or nothing can be written; what cannot be read of a
/// single job is a warning.
SummaryReport write_summary(const SummaryOptions& options);

}  // namespace ldso
