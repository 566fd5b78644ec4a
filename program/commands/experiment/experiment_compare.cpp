#include "commands/experiment/experiment_commands.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "experiment/results/experiment_results.h"
#include "experiment/results/results_file.h"
#include "experiment/summary/comparison.h"
#include "ldso/error.h"
#include "terminal/option_checks.h"
#include "util/format_text.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostNames = 10;  ///< Of jobs, in one message.

struct CompareArguments {
  fs::path a, b;
  LossLimits limits;
};

/// Results of an experiment's folder, or of a file that `summarize` has written.
std::vector<JobResult> load_results(const fs::path& path) {
  if (!fs::is_directory(path)) return read_results(path);
  const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  ExperimentResults results = collect_results(path, threads);
  for (const std::string& warning : results.warnings) std::cerr << "warning: " << warning << "\n";
  return std::move(results.jobs);
}

void print_names(std::ostream& out, const std::string& what, const std::vector<std::string>& ids) {
  if (ids.empty()) return;
  out << what << ":";
  for (std::size_t i = 0; i < std::min(ids.size(), kMostNames); ++i) out << " " << ids[i];
  if (ids.size() > kMostNames) out << " and " << ids.size() - kMostNames << " more";
  out << "\n";
}

/// Names all that are missing, so that nobody learns of the second after having mended the first.
void check_present(const std::vector<fs::path>& paths) {
  std::string missing;
  for (const fs::path& path : paths) {
    if (!fs::exists(path)) missing += (missing.empty() ? "" : ", ") + path.string();
  }
  if (!missing.empty())
    throw Error(missing, "there is no such folder or file", "give the folders of two `ldso experiment run`");
}

void compare(const CompareArguments& a, int& exit_code) {
  check_present({a.a, a.b});
  const ExperimentComparison comparison = compare_experiments(load_results(a.a), load_results(a.b));
  std::cout << table_markdown(comparison_table(comparison)) << "\n";
  std::cout << format_text("overall       %+.2f %% (geometric mean of the changes of the medians), p %.4f, %zu runs\n",
                           100 * (comparison.ratio - 1), comparison.p, comparison.pairs);
  print_names(std::cout, "failed in B alone", comparison.newly_failed);
  print_names(std::cout, "failed in A alone", comparison.recovered);
  print_names(std::cerr, "warning: " + std::to_string(comparison.only_in_a.size()) + " runs have a result in A alone",
              comparison.only_in_a);
  print_names(std::cerr, "warning: " + std::to_string(comparison.only_in_b.size()) + " runs have a result in B alone",
              comparison.only_in_b);
  for (const std::string& loss : losses(comparison, a.limits)) {
    std::cout << "LOSS          " << loss << "\n";
    exit_code = kLossExitCode;
  }
}

}  // namespace

void add_experiment_compare_command(CLI::App& experiment, int& exit_code) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command = experiment.add_subcommand("compare", "Say what got better or worse from experiment A to B");
  command->add_option("A", arguments->a, "Folder of an experiment, or its results.csv or results.json")->required();
  command->add_option("B", arguments->b, "The same of another one, with the same plan")->required();
  command
      ->add_option(
          "--max-loss", arguments->limits.overall,
          "Exit with code 3 if B's errors are larger by more than this on the whole, or a run fails in B alone")
      ->check(number_from_zero())
      ->type_name("PERCENT");
  command
      ->add_option("--max-sequence-loss", arguments->limits.sequence,
                   "Exit with code 3 if those of any sequence and variant are")
      ->check(number_from_zero())
      ->type_name("PERCENT");
  command->callback([arguments, &exit_code] { compare(*arguments, exit_code); });
}

}  // namespace ldso
