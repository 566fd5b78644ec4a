// Plans of experiments.

#include "experiment/plan/experiment_plan.h"
#include "experiment/plan/plan_file.h"
#include "fuzz_target.h"

using namespace ldso;

LDSO_FUZZ_TARGET(plan_yaml) {
  const auto plan = fuzz::accepted([&] { return parse_plan(std::string(input), "plan.yaml", fuzz::scratch_folder()); });
  if (!plan) return;
  fuzz::expect(!plan->sequences.empty() && !plan->variants.empty(), "a plan has sequences and variants");
  const auto jobs = plan_jobs(*plan, fuzz::scratch_folder());
  fuzz::expect(jobs.size() == plan->sequences.size() * plan->variants.size() * plan->directions.size() *
                                  static_cast<std::size_t>(plan->repetitions),
               "each sequence is run in each way");
  for (const ExperimentJob& job : jobs)
    fuzz::expect(job.id.find("..") == std::string::npos || job.id.find("/..") == std::string::npos,
                 "no job leaves the experiment's folder");
}
