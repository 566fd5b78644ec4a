#include "experiment/summary/block_plot.h"

#include "experiment/summary/colour_scale.h"
#include "experiment/test_results.h"

namespace ldso {
namespace {

TEST(BlockPlot, HasASquareForEachRun) {
  std::vector<JobResult> results = {
      finished_result(test_job("a", "corners", 0), 0.1), finished_result(test_job("a", "corners", 1), 10),
      failed_result(test_job("b", "corners", 0), "lost at frame 7"), pending_result(test_job("b", "corners", 1)),
      finished_result(test_job("a", "random", 0, true), 1)};
  results.push_back(finished_result(test_job("b", "random", 0, true), 0));
  results.back().errors.ate.reset();
  const std::string svg = block_plot(group_by_dataset(results).front(), kAteError);
  EXPECT_EQ(count_of(svg, "<title>"), 6u);
  EXPECT_NE(svg.find("fill=\"" + viridis(0) +
                     "\" stroke=\"#c8c8c8\" stroke-width=\"0.5\"><title>a/corners/forward_0: 0.1000 m<"),
            std::string::npos);
  EXPECT_NE(svg.find("<title>b/corners/forward_0: failed (lost at frame 7)<"), std::string::npos);
  EXPECT_EQ(count_of(svg, "<path "), 2u);  // The cross of the failed run, and that of the legend.
  for (const char* text : {">failed: 1<", ">pending: 1<", ">not measured: 1<", ">corners<", ">random<", ">backward<",
                           ">a<", ">b<", ">sequence<", ">ATE [m]<"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(BlockPlot, LongNamesAreWrittenUpwards) {
  std::vector<JobResult> results;
  for (int i = 0; i < 50; ++i)
    results.push_back(finished_result(test_job("sequence_" + std::to_string(i), "corners", 0), 1));
  EXPECT_NE(block_plot(group_by_dataset(results).front(), kAteError).find("rotate(-90"), std::string::npos);
  results.resize(1);
  results[0].job.sequence = "a";
  EXPECT_EQ(block_plot(group_by_dataset(results).front(), kAteError).find("rotate(-90"), std::string::npos);
}

TEST(BlockPlot, ExistsWhereNothingIsFinished) {
  const std::vector<JobResult> results = {pending_result(test_job("a", "corners", 0))};
  EXPECT_NE(block_plot(group_by_dataset(results).front(), kAteError).find(">pending: 1<"), std::string::npos);
}

}  // namespace
}  // namespace ldso
