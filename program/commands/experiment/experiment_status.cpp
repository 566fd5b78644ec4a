#include "commands/experiment/experiment_commands.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "experiment/jobs/job_folder.h"
#include "experiment/jobs/run_file.h"
#include "experiment/results/experiment_listing.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

struct Counts {
  int finished = 0, failed = 0, running = 0, open = 0;

  Counts& operator+=(const Counts& other) {
    finished += other.finished;
    failed += other.failed;
    running += other.running;
    open += other.open;
    return *this;
  }
};

struct Row {
  std::string name;
  Counts counts;
};

struct Status {
  std::vector<Row> sequences;                                 ///< In the order of the plan.
  std::vector<std::pair<std::string, std::string>> failures;  ///< Id, reason.
};

Counts& counts_of(std::vector<Row>& rows, const std::string& name) {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.name == name; });
  if (found != rows.end()) return found->counts;
  rows.push_back({name, {}});
  return rows.back().counts;
}

Status read_status(const fs::path& experiment, const ExperimentListing& listing) {
  Status status;
  for (const std::string& id : listing.jobs) {
    const fs::path folder = job_folder(experiment, id);
    Counts& counts = counts_of(status.sequences, id.substr(0, id.find('/')));
    const RunOutcome outcome = read_run(folder);
    if (outcome.state == RunState::kFinished) {
      ++counts.finished;
    } else if (outcome.state == RunState::kFailed) {
      ++counts.failed;
      status.failures.emplace_back(id, outcome.reason);
    } else {
      ++(JobLock::is_held(folder) ? counts.running : counts.open);
    }
  }
  return status;
}

void print_row(const std::string& name, int width, const std::array<std::string, 4>& values) {
  std::cout << std::left << std::setw(width) << name << std::right;
  for (const std::string& value : values) std::cout << std::setw(10) << value;
  std::cout << "\n";
}

void print_counts(const std::string& name, int width, const Counts& c) {
  print_row(name, width,
            {std::to_string(c.finished), std::to_string(c.failed), std::to_string(c.running), std::to_string(c.open)});
}

void print_status(const fs::path& experiment) {
  const ExperimentListing listing = read_listing(experiment);
  const Status status = read_status(experiment, listing);
  std::size_t width = 8;
  for (const Row& row : status.sequences) width = std::max(width, row.name.size());
  const int column = static_cast<int>(width) + 2;
  if (!listing.title.empty()) std::cout << listing.title << "\n";
  print_row("sequence", column, {"finished", "failed", "running", "open"});
  Counts all;
  for (const Row& row : status.sequences) {
    print_counts(row.name, column, row.counts);
    all += row.counts;
  }
  print_counts("all", column, all);
  for (const auto& [id, reason] : status.failures) std::cout << id << ": failed: " << reason << "\n";
}

}  // namespace

void add_experiment_status_command(CLI::App& experiment) {
  CLI::App* command = experiment.add_subcommand("status", "Which jobs have ended and how");
  const auto folder = std::make_shared<fs::path>();
  command->add_option("experiment", *folder, "Folder of the experiment")->required();
  command->callback([folder] { print_status(*folder); });
}

}  // namespace ldso
