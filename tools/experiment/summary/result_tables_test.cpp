#include "experiment/summary/result_tables.h"

#include "experiment/test_results.h"

namespace ldso {
namespace {

std::vector<std::string> texts(const TableRow& row) {
  std::vector<std::string> result;
  for (const TableCell& cell : row) result.push_back(cell.text);
  return result;
}

JobResult closed_result(const ExperimentJob& job, double before, double after) {
  JobResult result = finished_result(job, after);
  result.odometry_errors.ate = before;
  return result;
}

std::vector<JobResult> some_results() {
  return {closed_result(test_job("00", "corners", 0), 30, 8), closed_result(test_job("00", "corners", 1), 50, 12),
          finished_result(test_job("00", "random", 0), 40),   failed_result(test_job("00", "random", 1)),
          failed_result(test_job("01", "corners", 0)),        pending_result(test_job("01", "random", 0))};
}

TEST(ErrorTable, MediansBesidePublishedFigures) {
  const auto results = some_results();
  const DatasetResults dataset = group_by_dataset(results).front();
  const std::vector<PublishedResults> published = {
      {"LDSO", "a paper", "euroc", "ate", "m", {{"00", 9.322}, {"01", std::nullopt}}},
      {"DSO", "a paper", "kitti", "ate", "m", {{"00", 1.0}}}};  // Of another data set.
  const TextTable table = *error_table(dataset, kAteError, published);
  EXPECT_EQ(table.name, "ate_euroc");
  EXPECT_EQ(table.head,
            (std::vector<std::string>{"sequence", "corners, before loops", "corners", "random", "LDSO (published)"}));
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(texts(table.rows[0]), (std::vector<std::string>{"00", "40.00", "10.00", "failed (1/2 failed)", "9.322"}));
  EXPECT_EQ(texts(table.rows[1]), (std::vector<std::string>{"01", "failed", "failed", "-", "failed"}));
  EXPECT_TRUE(table.rows[0][4].best);
  EXPECT_FALSE(table.rows[0][2].best);
  EXPECT_FALSE(table.rows[1][4].best);
}

TEST(ErrorTable, DoesNotExistWithoutValues) {
  const auto results = some_results();
  EXPECT_FALSE(error_table(group_by_dataset(results).front(), kKittiTranslation, {}).has_value());
}

TEST(ErrorTable, BothDirectionsHaveColumns) {
  const std::vector<JobResult> results = {finished_result(test_job("a", "corners", 0), 1),
                                          finished_result(test_job("a", "corners", 0, true), 2)};
  const TextTable table = *error_table(group_by_dataset(results).front(), kAteError, {});
  EXPECT_EQ(table.head, (std::vector<std::string>{"sequence", "corners", "corners, backward"}));
  EXPECT_EQ(texts(table.rows[0]), (std::vector<std::string>{"a", "1.000", "2.000"}));
}

TEST(SummaryTable, CountsAndMedians) {
  const auto results = some_results();
  const TextTable table = summary_table(group_by_dataset(results).front());
  EXPECT_EQ(table.head, (std::vector<std::string>{"variant", "runs", "failed", "pending", "ATE [m]"}));
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(texts(table.rows[0]), (std::vector<std::string>{"corners, forward, before loops", "3", "1", "0", "50.00"}));
  EXPECT_EQ(texts(table.rows[1]), (std::vector<std::string>{"corners, forward", "3", "1", "0", "12.00"}));
  EXPECT_EQ(texts(table.rows[2]), (std::vector<std::string>{"random, forward", "3", "1", "1", "failed"}));
}

TEST(RuntimeTable, MeansOverKeyframes) {
  std::vector<JobResult> results = some_results();
  results[0].stages = {{"keyframe/select", {10, 50}}, {"keyframe", {10, 1000}}, {"track", {100, 400}}};
  results[0].run.frames_per_s = 20;
  results[1].stages = {{"keyframe/select", {30, 270}}, {"keyframe", {30, 3000}}, {"track", {300, 1200}}};
  results[1].run.frames_per_s = 30;
  const std::vector<PublishedResults> published = {
      {"LDSO", "a paper", "any", "selection", "ms", {{"corners", 21.8}, {"random", 2.7}}}};
  const TextTable table = runtime_table(results, published);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(texts(table.rows[0]), (std::vector<std::string>{"corners", "2", "8.000", "100.0", "4.000", "25.00", "-"}));
  EXPECT_EQ(texts(table.rows[1]),
            (std::vector<std::string>{"LDSO, corners (published)", "-", "21.80", "-", "-", "-", "-"}));
}

TEST(ProblemTable, NamesJobsAndReasons) {
  const TextTable table = problem_table(some_results());
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(texts(table.rows[0]), (std::vector<std::string>{"00/random/forward_1", "failed", "lost at frame 7"}));
}

}  // namespace
}  // namespace ldso
