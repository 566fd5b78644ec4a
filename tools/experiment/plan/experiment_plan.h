#pragma once
// The plan of an experiment: sequences x variants x directions x repetitions, and the jobs that come of it.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiment/jobs/job.h"
#include "ldso/io/dataset.h"

namespace ldso {

/// What tells the repetitions of a job apart. ldso is deterministic: without a difference all of them are the same run.
enum class Vary {
  kStart,  ///< Repetition r begins r frames later (backward: leaves out the last r frames).
  kSeed,   ///< selection.seed is 1 + r. Corners hardly depend on it: it decides only where corners are too few.
  kNone,   ///< Nothing: for run times.
};

/// A row of the figures.
struct PlanVariant {
  std::string name;  ///< E.g. "corners_no_loops".
  std::string strategy = "corners";
  bool loops = true;
  std::vector<std::string> settings;  ///< "key=value"
};

/// A column of the figures, with all that its dataset and the plan say about it.
struct PlanSequence {
  std::string name;
  std::string dataset;
  std::filesystem::path path;  ///< Empty: nothing says where the dataset lies.
  /// Relative to `path`; "a|b": one of both. Checked before anything runs.
  std::vector<std::string> needs;
  std::string download;  ///< Where the dataset can be got, for people.
  DatasetOptions playback;
  JobMetric metric = JobMetric::kAte;
  std::optional<std::filesystem::path> ground_truth;
  std::optional<std::filesystem::path> config;
  std::vector<std::string> settings;  ///< "key=value", the plan's own first, then the dataset's.
};

struct ExperimentPlan {
  std::string origin;  ///< File, for messages.
  std::string title;
  std::vector<PlanSequence> sequences;
  std::vector<PlanVariant> variants;
  std::vector<bool> directions{false};  ///< Whether reversed.
  int repetitions = 1;
  Vary vary = Vary::kStart;
  int threads = 2;          ///< Of a job.
  std::optional<int> jobs;  ///< How many at a time; nothing: as many as there are cores for.
};

/// All jobs in the order in which they are run: a first repetition of everything, then a second of everything, so that
/// figures drawn meanwhile show all sequences. Results go to `experiment`/jobs/<id>.
std::vector<ExperimentJob> plan_jobs(const ExperimentPlan& plan, const std::filesystem::path& experiment);

/// The jobs whose id matches one of the patterns (`*`, `?` and `[..]` as in a shell, but `*` also stands for `/`;
/// without any of them: contains the text). All of them if there is no pattern. Throws Error naming a pattern that none
/// matches.
std::vector<ExperimentJob> select_jobs(const std::vector<ExperimentJob>& jobs,
                                       const std::vector<std::string>& patterns);

/// A sequence that cannot be run.
struct IncompleteSequence {
  std::string name;
  std::string dataset;
  std::vector<std::string> missing;  ///< Folders and files; none if nothing says where the dataset lies.
  std::string download;
};

/// Looks for the folder of each sequence and for what it needs; opens nothing.
std::vector<IncompleteSequence> find_incomplete(const ExperimentPlan& plan);

/// For people: all that is missing and where to get it. Several lines.
std::string describe_incomplete(const std::vector<IncompleteSequence>& sequences, std::size_t planned);

/// Takes the sequences out of the plan.
void remove_sequences(ExperimentPlan& plan, const std::vector<IncompleteSequence>& sequences);

}  // namespace ldso
