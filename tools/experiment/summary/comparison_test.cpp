#include "experiment/summary/comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "experiment/test_results.h"
#include "ldso/error.h"

namespace ldso {
namespace {

/// Repetitions 0, 1, ... of a sequence with these errors; below zero: failed.
void add_runs(std::vector<JobResult>& results, const std::string& sequence, const std::vector<double>& errors) {
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const ExperimentJob job = test_job(sequence, "corners", static_cast<int>(i));
    results.push_back(errors[i] < 0 ? failed_result(job) : finished_result(job, errors[i]));
  }
}

std::vector<JobResult> runs_of(const std::string& sequence, const std::vector<double>& errors) {
  std::vector<JobResult> results;
  add_runs(results, sequence, errors);
  return results;
}

TEST(Comparison, MediansRatiosAndProbability) {
  std::vector<JobResult> a = runs_of("x", {1, 2, 3, 4, 5, 6}), b = runs_of("x", {2, 4.2, 6.3, 8.4, 10.5, 12.6});
  add_runs(a, "y", {1, 1, 1});
  add_runs(b, "y", {0.5, 0.5, 0.5});
  const ExperimentComparison comparison = compare_experiments(a, b);
  ASSERT_EQ(comparison.sequences.size(), 2u);
  EXPECT_EQ(comparison.sequences[0].pairs, 6u);
  EXPECT_DOUBLE_EQ(comparison.sequences[0].median_a, 3.5);
  EXPECT_DOUBLE_EQ(*comparison.sequences[0].ratio, 7.35 / 3.5);
  EXPECT_DOUBLE_EQ(comparison.sequences[0].p, 2.0 / 64);  // All of six are larger.
  EXPECT_DOUBLE_EQ(comparison.sequences[1].p, 1);         // Three times the same run is one.
  EXPECT_NEAR(comparison.ratio, std::sqrt(0.5 * 7.35 / 3.5), 1e-12);
  EXPECT_EQ(comparison.pairs, 9u);
  const TextTable table = comparison_table(comparison);
  EXPECT_EQ(table.rows[0].back().text, "worse (p < 0.05)");
  EXPECT_EQ(table.rows[1].back().text, "better");
  EXPECT_EQ(table.rows[0][7].text, "+110.0 %");
}

TEST(Comparison, PairsByIdWhateverTheOrder) {
  const std::vector<JobResult> a = runs_of("x", {1, 10}), b = runs_of("x", {1, 10});
  const std::vector<JobResult> turned = {b[1], b[0]};
  EXPECT_EQ(compare_experiments(a, turned).p, 1);
  EXPECT_EQ(compare_experiments(a, turned).ratio, 1);
}

TEST(Comparison, FailuresCount) {
  const std::vector<JobResult> a = runs_of("x", {1, 2, -1, 4}), b = runs_of("x", {1, -1, 3, 4});
  const ExperimentComparison comparison = compare_experiments(a, b);
  EXPECT_EQ(comparison.newly_failed, std::vector<std::string>{"x/corners/forward_1"});
  EXPECT_EQ(comparison.recovered, std::vector<std::string>{"x/corners/forward_2"});
  EXPECT_EQ(comparison.sequences[0].failed_a, 1u);
  EXPECT_EQ(comparison.sequences[0].failed_b, 1u);
  EXPECT_EQ(losses(comparison, {}).size(), 0u);
  EXPECT_EQ(losses(comparison, {1000.0, {}}), std::vector<std::string>{"x/corners/forward_1 fails now"});
}

TEST(Comparison, MedianThatFailsNowIsALossOfTheSequence) {
  const ExperimentComparison comparison = compare_experiments(runs_of("x", {1, 2, 3}), runs_of("x", {1, -1, -1}));
  EXPECT_TRUE(std::isinf(comparison.sequences[0].median_b));
  EXPECT_FALSE(comparison.sequences[0].ratio.has_value());
  EXPECT_EQ(losses(comparison, {{}, 50.0}).size(), 1u);
  EXPECT_EQ(comparison_table(comparison).rows[0].back().text, "worse");
  const ExperimentComparison both = compare_experiments(runs_of("x", {-1, -1}), runs_of("x", {-1, -1}));
  EXPECT_EQ(comparison_table(both).rows[0].back().text, "fails in both");
  EXPECT_TRUE(losses(both, {0.0, 0.0}).empty());
}

TEST(Comparison, LimitsAreOfTheWholeAndOfSequences) {
  std::vector<JobResult> a = runs_of("x", {1.0}), b = runs_of("x", {1.2});
  add_runs(a, "y", {1});
  add_runs(b, "y", {0.9});
  const ExperimentComparison comparison = compare_experiments(a, b);  // sqrt(1.08) = 1.039
  EXPECT_TRUE(losses(comparison, {4.0, {}}).empty());
  EXPECT_EQ(losses(comparison, {3.0, {}}), std::vector<std::string>{"overall +3.9 %"});
  EXPECT_TRUE(losses(comparison, {{}, 21.0}).empty());
  EXPECT_EQ(losses(comparison, {{}, 19.0}), std::vector<std::string>{"x, corners: +20.0 %"});
}

TEST(Comparison, NamesWhatOneAloneHas) {
  std::vector<JobResult> a = runs_of("x", {1, 2, 3}), b = runs_of("x", {1, 2});
  add_runs(b, "z", {1});
  b.push_back(pending_result(test_job("x", "corners", 2)));
  const ExperimentComparison comparison = compare_experiments(a, b);
  EXPECT_EQ(comparison.only_in_a, std::vector<std::string>{"x/corners/forward_2"});
  EXPECT_EQ(comparison.only_in_b, std::vector<std::string>{"z/corners/forward_0"});
  EXPECT_EQ(comparison.pairs, 2u);
}

TEST(Comparison, RefusesWhatCannotBeCompared) {
  EXPECT_THROW(compare_experiments(runs_of("x", {1}), runs_of("y", {1})), Error);
  std::vector<JobResult> other = runs_of("x", {1});
  other[0].job.metric = JobMetric::kTumMono;
  other[0].errors.e_align = 1;
  EXPECT_THROW(compare_experiments(runs_of("x", {1}), other), Error);
  std::vector<JobResult> twice = runs_of("x", {1});
  twice.push_back(twice.front());
  EXPECT_THROW(compare_experiments(twice, twice), Error);
}

}  // namespace
}  // namespace ldso
