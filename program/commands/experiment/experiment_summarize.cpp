#include "commands/experiment/experiment_commands.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <thread>

#include "experiment/summary/summary.h"
#include "terminal/svg_to_png.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostWarnings = 10;  ///< Printed; all are in the summary.

struct SummarizeArguments {
  SummaryOptions options;
  bool png = false, no_trajectories = false, quiet = false;
};

void print_warnings(const SummaryReport& report) {
  const std::size_t shown = std::min(report.warnings.size(), kMostWarnings);
  for (std::size_t i = 0; i < shown; ++i) std::cerr << "warning: " << report.warnings[i] << "\n";
  if (shown < report.warnings.size()) {
    std::cerr << "warning: " << report.warnings.size() - shown << " more are in the summary\n";
  }
}

void summarize_from(SummarizeArguments& a) {
  SummaryOptions& options = a.options;
  if (options.output.empty()) options.output = options.experiment / "summary";
  options.trajectories = !a.no_trajectories;
  options.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  if (a.png && can_make_png()) {
    options.make_png = make_png;
  } else if (a.png) {
    std::cerr << "warning: no PNG files: " << kPngProgram << " is not installed (Debian package librsvg2-bin)\n";
  }
  const SummaryReport report = write_summary(options);
  print_warnings(report);
  if (a.quiet) return;
  std::cout << report.overview << "runs      " << report.finished << " finished, " << report.failed << " failed, "
            << report.pending << " pending\n"
            << "summary   " << (options.output / "index.html").string() << " (" << report.figures << " figures, "
            << report.tables << " tables)\n";
}

}  // namespace

void add_experiment_summarize_command(CLI::App& experiment) {
  auto arguments = std::make_shared<SummarizeArguments>();
  SummaryOptions& options = arguments->options;
  CLI::App* command =
      experiment.add_subcommand("summarize", "Draw figures and tables of an experiment from what is finished");
  command->add_option("experiment", options.experiment, "Folder of the experiment")->required();
  command->add_option("-o,--out", options.output, "Folder for figures and tables (default: summary/ in that folder)");
  command->add_option("--published", options.published, "Published figures (YAML) instead of the built-in ones")
      ->check(CLI::ExistingFile);
  command->add_flag("--log-axes", options.curves.log_axis, "Logarithmic error axes of the cumulative curves");
  command->add_flag("--png", arguments->png, "Also write each figure as PNG (takes rsvg-convert)");
  command->add_flag("--no-trajectories", arguments->no_trajectories, "Do not draw trajectories");
  command->add_flag("--quiet", arguments->quiet, "Print warnings only");
  command->callback([arguments] { summarize_from(*arguments); });
}

void summarize_experiment(const fs::path& experiment, bool quiet) {
  SummarizeArguments arguments;
  arguments.quiet = quiet;
  arguments.options.experiment = experiment;
  summarize_from(arguments);
}

}  // namespace ldso
