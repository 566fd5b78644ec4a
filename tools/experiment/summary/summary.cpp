#include "experiment/summary/summary.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "experiment/jobs/job_folder.h"
#include "experiment/results/experiment_results.h"
#include "experiment/results/results_file.h"
#include "experiment/summary/result_figures.h"
#include "experiment/summary/result_tables.h"
#include "experiment/summary/summary_page.h"
#include "io/text/output_folder.h"
#include "ldso/error.h"
#include "util/thread_pool.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFigureFolder = "figures/";
constexpr const char* kTableFolder = "tables/";

/// Whether there is a summary of a version that kept no list of its files.
bool has_summary(const fs::path& folder) {
  try {
    read_results(folder / "results.csv");
    return true;
  } catch (const Error&) {
    return false;
  }
}

OutputFolder open_summary_folder(const fs::path& folder) {
  const std::vector<std::string> names{"results.csv", "results.json", "summary.md",
                                       "index.html",  kFigureFolder,  kTableFolder};
  OutputFolder out(folder);
  if (!out.has_list() && has_summary(folder)) out.adopt(names);
  out.check(names);
  return out;
}

void count_states(const std::vector<JobResult>& jobs, SummaryReport& report) {
  for (const JobResult& job : jobs) {
    if (job.state == RunState::kFinished) ++report.finished;
    if (job.state == RunState::kFailed) ++report.failed;
    if (job.state == RunState::kPending) ++report.pending;
  }
}

/// What belongs to one data set, on its way to files.
struct Section {
  std::string title;
  std::vector<TextTable> tables;
  std::vector<Figure> figures;
};

void add_error_tables(const DatasetResults& dataset, const std::vector<PublishedResults>& published, Section& section) {
  for (const ErrorKind* kind : error_kinds(dataset.metric)) {
    if (std::optional<TextTable> table = error_table(dataset, *kind, published)) {
      section.tables.push_back(std::move(*table));
    }
  }
}

/// Trajectories of all data sets, several at a time, each into its section.
void add_trajectories(const SummaryOptions& options, const std::vector<DatasetResults>& datasets,
                      std::vector<Section>& sections, SummaryReport& report) {
  struct Drawing {
    const JobResult* run = nullptr;
    Section* section = nullptr;
    Figure figure;
    std::string problem;
  };
  std::vector<Drawing> drawings;
  std::vector<const ExperimentJob*> jobs;
  for (std::size_t i = 0; i < datasets.size(); ++i) {
    for (const JobResult* run : representative_runs(datasets[i])) {
      drawings.push_back({run, &sections[i], {}, {}});
      jobs.push_back(&run->job);
    }
  }
  GroundTruths truths;
  truths.load(jobs, options.threads);
  ThreadPool pool(options.threads);
  pool.run(static_cast<int>(drawings.size()), [&](int i) {
    Drawing& drawing = drawings[static_cast<std::size_t>(i)];
    try {
      const fs::path folder = options.experiment / "jobs" / drawing.run->job.id;
      drawing.figure = trajectory_figure(folder, *drawing.run, truths.of(drawing.run->job));
    } catch (const Error& error) {
      drawing.problem = "trajectory not drawn: " + std::string(error.what());
    }
  });
  for (Drawing& drawing : drawings) {
    if (drawing.problem.empty()) {
      drawing.section->figures.push_back(std::move(drawing.figure));
    } else if (std::find(report.warnings.begin(), report.warnings.end(), drawing.problem) == report.warnings.end()) {
      report.warnings.push_back(drawing.problem);
    }
  }
}

void write_table(const fs::path& folder, const TextTable& table) {
  write_file(folder / (table.name + ".csv"), table_csv(table));
  write_file(folder / (table.name + ".md"), table_markdown(table));
  write_file(folder / (table.name + ".tex"), table_latex(table));
}

/// Writes the figures and says where they are.
std::vector<FigureLink> write_figures(const SummaryOptions& options, const std::vector<Figure>& figures) {
  std::vector<FigureLink> links(figures.size());
  ThreadPool pool(options.threads);
  pool.run(static_cast<int>(figures.size()), [&](int index) {
    const auto i = static_cast<std::size_t>(index);
    links[i] = {kFigureFolder + figures[i].name, figures[i].caption, false};
    const fs::path svg = options.output / (links[i].file + ".svg"), png = options.output / (links[i].file + ".png");
    write_file(svg, figures[i].svg);
    std::error_code ignored;
    fs::remove(png, ignored);  // That of an earlier summary would show something else.
    if (options.make_png) links[i].has_png = options.make_png(svg, png);
  });
  return links;
}

SummaryPage write_sections(const SummaryOptions& options, const std::vector<Section>& sections, OutputFolder& out,
                           SummaryReport& report) {
  create_folder(out.file(kFigureFolder));
  create_folder(out.file(kTableFolder));
  SummaryPage page;
  for (const Section& section : sections) {
    for (const TextTable& table : section.tables) write_table(out.path() / kTableFolder, table);
    page.sections.push_back({section.title, section.tables, write_figures(options, section.figures)});
    report.tables += section.tables.size();
    report.figures += section.figures.size();
  }
  return page;
}

std::string state_line(const SummaryReport& report) {
  return std::to_string(report.finished + report.failed + report.pending) +
         " runs: " + std::to_string(report.finished) + " finished, " + std::to_string(report.failed) + " failed, " +
         std::to_string(report.pending) + " pending";
}

std::vector<Section> sections_of(const SummaryOptions& options, const std::vector<JobResult>& jobs,
                                 SummaryReport& report) {
  const std::vector<PublishedResults> published =
      options.published ? read_published(*options.published) : built_in_published();
  const std::vector<DatasetResults> datasets = group_by_dataset(jobs);
  std::vector<Section> sections;
  for (const DatasetResults& dataset : datasets) {
    Section section{dataset.name.empty() ? "Sequences" : dataset.name, {summary_table(dataset)}, {}};
    report.overview += section.tables.front().caption + "\n\n" + table_markdown(section.tables.front()) + "\n";
    add_error_tables(dataset, published, section);
    section.figures = error_figures(dataset, options.curves);
    sections.push_back(std::move(section));
  }
  if (options.trajectories) add_trajectories(options, datasets, sections, report);
  if (TextTable table = runtime_table(jobs, published); !table.rows.empty()) {
    sections.push_back({"Runtime", {std::move(table)}, {}});
  }
  if (TextTable table = problem_table(jobs); !table.rows.empty()) {
    sections.push_back({"Runs without a result", {std::move(table)}, {}});
  }
  return sections;
}

}  // namespace

SummaryReport write_summary(const SummaryOptions& options) {
  ExperimentResults results = collect_results(options.experiment, options.threads);
  if (results.jobs.empty()) {
    throw Error(options.experiment.string(), "holds no job that can be read",
                results.warnings.empty() ? "has the experiment been started?" : results.warnings.front());
  }
  SummaryReport report;
  report.warnings = std::move(results.warnings);
  count_states(results.jobs, report);
  const std::vector<Section> sections = sections_of(options, results.jobs, report);
  const JobLock lock = JobLock::wait_for_folder(options.experiment);  // Two runners may end at the same moment.
  OutputFolder out = open_summary_folder(options.output);
  SummaryPage page = write_sections(options, sections, out, report);
  page.title = "Experiment " + fs::absolute(options.experiment).lexically_normal().filename().string();
  page.lines = {state_line(report),
                "all figures of each run: results.csv, results.json; tables as CSV, Markdown and LaTeX: tables/"};
  page.warnings = report.warnings;
  write_file(out.file("results.csv"), results_csv(results.jobs));
  write_file(out.file("results.json"), results_json(results.jobs));
  write_file(out.file("summary.md"), summary_markdown(page));
  write_file(out.file("index.html"), summary_html(page));
  return report;
}

}  // namespace ldso
