// What an experiment reads of its jobs: run.json, failure.json, job.json, experiment.json.

#include "experiment/jobs/job_file.h"
#include "experiment/jobs/run_file.h"
#include "experiment/results/experiment_listing.h"
#include "fuzz_target.h"

using namespace ldso;

LDSO_FUZZ_TARGET(run_json) {
  for (const char* name : {"run.json", "job.json", "experiment.json"}) fuzz::scratch_file(name, input);
  const std::filesystem::path& folder = fuzz::scratch_folder();
  read_run(folder);
  std::filesystem::rename(folder / "run.json", folder / kFailureName);
  read_run(folder);
  std::filesystem::rename(folder / kFailureName, folder / "run.json");
  if (const auto listing = fuzz::accepted([&] { return read_listing(folder); })) shell_quoted(listing->jobs);
  const auto job = fuzz::accepted([&] { return read_job(folder); });
  if (!job) return;
  write_job(folder / "again", *job);
  const ExperimentJob again = read_job(folder / "again");
  fuzz::expect(again.id == job->id && again.arguments == job->arguments, "a written job reads back as it was");
}
