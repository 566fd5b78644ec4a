#include "experiment/summary/cumulative_plot.h"

#include "experiment/test_results.h"

namespace ldso {
namespace {

std::vector<JobResult> some_results() {
  std::vector<JobResult> results;
  for (int i = 0; i < 10; ++i) results.push_back(finished_result(test_job("a", "corners", i), 0.1 * (i + 1)));
  results.push_back(finished_result(test_job("a", "corners", 10), 50));
  results.push_back(failed_result(test_job("a", "corners", 11)));
  results.push_back(pending_result(test_job("a", "corners", 12)));
  results.push_back(finished_result(test_job("a", "random", 0), 0.5));
  return results;
}

TEST(CumulativePlot, AxisEndsAtRoundNumbers) {
  EXPECT_DOUBLE_EQ(round_axis_end(0.011), 0.02);
  EXPECT_DOUBLE_EQ(round_axis_end(2.1), 3);
  EXPECT_DOUBLE_EQ(round_axis_end(3.1), 5);
  EXPECT_DOUBLE_EQ(round_axis_end(5), 5);
  EXPECT_DOUBLE_EQ(round_axis_end(60), 75);
  EXPECT_DOUBLE_EQ(round_axis_end(80), 100);
}

TEST(CumulativePlot, HasACurveForEachVariantAndSaysWhatIsMissing) {
  const auto results = some_results();
  const std::string svg = cumulative_plot(group_by_dataset(results).front(), kAteError);
  EXPECT_EQ(count_of(svg, "<polyline"), 2u);
  EXPECT_NE(svg.find(">corners (13 runs)<"), std::string::npos);
  EXPECT_NE(svg.find(">1 failed, 1 beyond the axis, 1 pending<"), std::string::npos);
  EXPECT_NE(svg.find(">random (1 runs)<"), std::string::npos);
  EXPECT_NE(svg.find(">ATE [m]<"), std::string::npos);
  EXPECT_NE(svg.find(">1.0<"), std::string::npos);
  EXPECT_EQ(svg.find(">50"), std::string::npos);
}

TEST(CumulativePlot, CurvesBeforeLoopsAreDashed) {
  auto results = some_results();
  results[0].odometry_errors.ate = 0.7;
  const std::string svg = cumulative_plot(group_by_dataset(results).front(), kAteError);
  EXPECT_EQ(count_of(svg, "<polyline"), 3u);
  EXPECT_NE(svg.find(">corners, before loops (13 runs)<"), std::string::npos);
  EXPECT_NE(svg.find("stroke-dasharray"), std::string::npos);
}

TEST(CumulativePlot, LogarithmicAxisShowsAll) {
  const auto results = some_results();
  const std::string svg = cumulative_plot(group_by_dataset(results).front(), kAteError, {true});
  EXPECT_NE(svg.find("ATE [m] (logarithmic)"), std::string::npos);
  EXPECT_EQ(svg.find("beyond"), std::string::npos);
  for (const char* tick : {">0.1<", ">1<", ">10<", ">50<"}) EXPECT_NE(svg.find(tick), std::string::npos) << tick;
}

TEST(CumulativePlot, ExistsWithoutAnyValue) {
  const std::vector<JobResult> results = {failed_result(test_job("a", "corners", 0))};
  for (const bool log : {false, true}) {
    const std::string svg = cumulative_plot(group_by_dataset(results).front(), kAteError, {log});
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
  }
}

}  // namespace
}  // namespace ldso
