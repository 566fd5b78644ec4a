#pragma once
// One run of one sequence within an experiment: what was asked for, and where its results lie.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace ldso {

/// The error by which a sequence is judged.
enum class JobMetric {
  kAte,      ///< RMSE of the positions after Sim(3) alignment [m].
  kTumMono,  ///< e_align of the TUM-mono benchmark [m], for ground truth at the start and the end only.
};

/// The results of a job lie in `<experiment>/jobs/<id>/`, which holds
/// - job.json: the members of this struct; written before the job is started or printed;
/// - what `ldso run -o` writes there. run.json comes last: where it exists and does not say `interrupted`, the job has
///   ended (its `error` or a trajectory that is too short make it a failed one);
/// - failure.json: `{"exit_code": int, "signal": int or null, "reason": string}`, written by the runner where
///   `ldso run` ended without a run.json (a sequence that cannot be opened, a crash); the job has failed;
/// - log.txt: what the job has printed;
/// - lock: held (flock) by the runner while the job runs; its content means nothing.
struct ExperimentJob {
  std::string id;        ///< Unique in the experiment; a relative path: <sequence>/<variant>/<direction>_<repetition>.
  std::string sequence;  ///< Short name, a column of the figures.
  std::string dataset;   ///< "tum_mono", "euroc", "kitti" or any other name; sequences of one dataset share figures.
  std::filesystem::path path;  ///< The sequence's folder.
  std::string variant;         ///< E.g. "corners", "corners_no_loops": a row of the figures.
  std::string strategy;        ///< corners, gradient or random.
  bool loops = true;
  bool reverse = false;
  int repetition = 0;
  JobMetric metric = JobMetric::kAte;
  std::optional<std::filesystem::path> ground_truth;  ///< Without: the sequence's own.
  std::vector<std::string> arguments;                 ///< Of the program: "run", the sequence, "-o", ...
};

/// visit(name, member) for what job.json and the results files both say of a job, its metric apart; `Job` may be const.
template <class Job, class Visitor>
void visit_identity(Job& job, Visitor&& visit) {
  visit("id", job.id);
  visit("dataset", job.dataset);
  visit("sequence", job.sequence);
  visit("variant", job.variant);
  visit("strategy", job.strategy);
  visit("loops", job.loops);
  visit("reverse", job.reverse);
  visit("repetition", job.repetition);
}

}  // namespace ldso
