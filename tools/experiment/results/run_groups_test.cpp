#include "experiment/results/run_groups.h"

#include <limits>

#include "experiment/test_results.h"

namespace ldso {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<const JobResult*> pointers(const std::vector<JobResult>& results) {
  std::vector<const JobResult*> all;
  for (const JobResult& result : results) all.push_back(&result);
  return all;
}

TEST(CountedError, OfEachState) {
  const ExperimentJob job = test_job("a", "corners", 0);
  EXPECT_EQ(counted_error(finished_result(job, 0.5), kAteError), 0.5);
  EXPECT_EQ(counted_error(finished_result(job, 0.5), kAlignmentError), std::nullopt);
  EXPECT_EQ(counted_error(failed_result(job), kAteError), kInfinity);
  EXPECT_EQ(counted_error(pending_result(job), kAteError), std::nullopt);
}

TEST(CountedError, ShrinkingScaleCountsAsGrowing) {
  JobResult result = finished_result(test_job("a", "corners", 0), 1);
  result.errors.e_s = 0.8;
  result.odometry_errors.e_s = 1.5;
  EXPECT_DOUBLE_EQ(*counted_error(result, kScaleDrift), 1.25);
  EXPECT_DOUBLE_EQ(*counted_error(result, kScaleDrift, Trajectories::kBeforeLoops), 1.5);
}

TEST(RunGroups, ByDatasetAndMetric) {
  std::vector<JobResult> results = {
      finished_result(test_job("b", "random", 0), 1), finished_result(test_job("a", "corners", 0), 1),
      finished_result(test_job("a", "random", 0), 1), finished_result(test_job("c", "corners", 0), 1)};
  results[3].job.dataset = "a data/set";
  const auto groups = group_by_dataset(results);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].file_name, "a_data_set");
  EXPECT_EQ(groups[1].name, "euroc");
  EXPECT_EQ(groups[1].sequences, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(groups[1].variants, (std::vector<std::string>{"corners", "random"}));
  EXPECT_EQ(groups[1].jobs.size(), 3u);

  results[0].job.metric = JobMetric::kTumMono;
  const auto split = group_by_dataset(results);
  ASSERT_EQ(split.size(), 3u);
  EXPECT_EQ(split[1].file_name, "euroc_ate");
  EXPECT_EQ(split[2].file_name, "euroc_tum_mono");
}

TEST(RunGroups, SelectAndCount) {
  std::vector<JobResult> results = {
      finished_result(test_job("a", "corners", 0), 3), finished_result(test_job("a", "corners", 1), 1),
      failed_result(test_job("a", "corners", 2)), pending_result(test_job("a", "corners", 3)),
      finished_result(test_job("a", "corners", 0, true), 9)};
  results.push_back(finished_result(test_job("a", "corners", 4), 0));
  results.back().errors.ate.reset();
  const GroupErrors errors = collect_errors(select(pointers(results), {"a", "corners", false}), kAteError);
  EXPECT_EQ(errors.values, (std::vector<double>{1, 3, kInfinity}));
  EXPECT_EQ(errors.failed, 1u);
  EXPECT_EQ(errors.pending, 1u);
  EXPECT_EQ(errors.unmeasured, 1u);
  EXPECT_EQ(errors.median(), 3);
  EXPECT_EQ(collect_errors({}, kAteError).median(), std::nullopt);
  EXPECT_TRUE(select(pointers(results), {"b", {}, {}}).empty());
}

TEST(RunGroups, LoopsThatMovedNothingDoNotCount) {
  std::vector<JobResult> results = {finished_result(test_job("a", "corners", 0), 3),
                                    failed_result(test_job("a", "corners", 1))};
  EXPECT_FALSE(any_changed_by_loops(pointers(results), kAteError));
  results[0].odometry_errors.ate = 4;
  EXPECT_TRUE(any_changed_by_loops(pointers(results), kAteError));
}

}  // namespace
}  // namespace ldso
