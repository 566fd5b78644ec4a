#include "evaluation/trajectory_picture.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "evaluation/svg_chart.h"
#include "evaluation/test_trajectories.h"
#include "ldso/error.h"

namespace ldso {
namespace {

std::size_t occurrences(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

TEST(SvgChart, TicksAreRoundAndInside) {
  EXPECT_EQ(round_ticks({0, 10}, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  const std::vector<double> ticks = round_ticks({-0.33, 0.41}, 4);
  ASSERT_EQ(ticks.size(), 4u);
  EXPECT_NEAR(ticks.front(), -0.2, 1e-12);
  EXPECT_NEAR(ticks.back(), 0.4, 1e-12);
}

TEST(SvgChart, EqualScaleWidensTheNarrowRange) {
  Range x{0, 10}, y{0, 1};
  SvgChart::make_equal_scale({0, 0, 200, 100}, x, y);
  EXPECT_DOUBLE_EQ(x.length(), 10);
  EXPECT_DOUBLE_EQ(y.length(), 5);
  EXPECT_DOUBLE_EQ(y.min, -2);
}

TEST(SvgChart, EscapesText) { EXPECT_EQ(xml_escape("a<b & \"c\">"), "a&lt;b &amp; &quot;c&quot;&gt;"); }

TEST(SvgChart, TicksOfCountsAreWhole) {
  std::vector<std::string> labels;
  for (const Tick& tick : number_ticks({0, 3.1}, 7, true)) labels.push_back(tick.label);
  EXPECT_EQ(labels, (std::vector<std::string>{"0", "1", "2", "3"}));
  EXPECT_EQ(number_ticks({0, 3.1}, 7).at(1).label, "0.5");
}

TEST(SvgChart, LogTicksAreNumbers) {
  std::vector<std::string> labels;
  for (const Tick& tick : log_ticks({-1.01, 0.8})) labels.push_back(tick.label);
  EXPECT_EQ(labels, (std::vector<std::string>{"0.1", "0.2", "0.5", "1", "2", "5"}));
  EXPECT_EQ(log_ticks({-2, 3}).size(), 6u);
  EXPECT_DOUBLE_EQ(log_ticks({-2, 3}).front().position, -2);
}

TEST(TrajectoryPicture, BeforeAndAfterLoopsOverGroundTruth) {
  const Trajectory truth = winding_trajectory(100);
  Trajectory before = truth;
  for (std::size_t i = 0; i < before.size(); ++i) {
    before[i].T_world_camera.translation() *= 1 + 0.002 * static_cast<double>(i);
  }
  const std::string svg = loop_picture(before, truth, truth, "room");
  EXPECT_EQ(occurrences(svg, "<polyline"), 5u);  // Truth and two estimates, and the errors of these.
  EXPECT_NE(svg.find(">before loop closing<"), std::string::npos);
  EXPECT_NE(svg.find(">after loop closing<"), std::string::npos);
  EXPECT_NE(svg.find("m after loop closing; both aligned over the whole"), std::string::npos);

  Trajectory ends = truth;
  ends.erase(ends.begin() + 30, ends.end() - 30);
  const std::string of_ends = loop_picture(before, truth, ends, "room");
  EXPECT_EQ(occurrences(of_ends, "<polyline"), 4u);  // The truth in two pieces, no errors.
  EXPECT_NE(of_ends.find("both aligned to the start segment"), std::string::npos);
}

TEST(TrajectoryPicture, ShowsTheTwoMainAxesAndTheError) {
  const Trajectory truth = winding_trajectory(100);
  const EvaluationResult result = evaluate_trajectory(transformed(some_similarity(), truth), truth);
  PictureOptions options;
  options.title = "room <1>";
  const std::string svg = trajectory_picture(transformed(some_similarity(), truth), truth, result, options);
  EXPECT_EQ(svg.rfind("<svg ", 0), 0u);
  EXPECT_NE(svg.find("room &lt;1&gt;: ATE "), std::string::npos);
  EXPECT_NE(svg.find(">x [m]<"), std::string::npos);  // y hardly moves.
  EXPECT_NE(svg.find(">z [m]<"), std::string::npos);
  EXPECT_EQ(svg.find(">y [m]<"), std::string::npos);
  EXPECT_NE(svg.find("error [m]"), std::string::npos);
  EXPECT_EQ(occurrences(svg, "<polyline"), 3u);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(TrajectoryPicture, BreaksTheLineWherePosesAreMissing) {
  const Trajectory truth = winding_trajectory(100);
  Trajectory estimate = truth;
  estimate.erase(estimate.begin() + 40, estimate.begin() + 60);
  PictureOptions options;
  options.error_panel = false;
  const std::string svg = trajectory_picture(estimate, truth, evaluate_trajectory(estimate, truth), options);
  EXPECT_EQ(occurrences(svg, "<polyline"), 3u);
}

TEST(TrajectoryPicture, LeavesOutTruthFarFromAnExcerpt) {
  const Trajectory truth = straight_trajectory(1000);
  Trajectory estimate = transformed(some_similarity(), Trajectory(truth.begin(), truth.begin() + 100));
  const EvaluationResult result = evaluate_trajectory(estimate, truth);
  const Trajectory near(truth.begin(), truth.begin() + 109);
  EXPECT_EQ(trajectory_picture(estimate, truth, result), trajectory_picture(estimate, near, result));
}

TEST(TrajectoryPicture, OfTheEstimateAloneIsInMapUnits) {
  const std::string svg = trajectory_picture(winding_trajectory(50));
  EXPECT_NE(svg.find("x [map units]"), std::string::npos);
  EXPECT_EQ(occurrences(svg, "<polyline"), 1u);
  EXPECT_THROW(trajectory_picture(Trajectory{}), Error);
  EXPECT_EQ(trajectory_picture(Trajectory(1)).find("nan"), std::string::npos);
}

TEST(TrajectoryPicture, IsWrittenToAFileOrSaysWhyNot) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "trajectory_picture_test.svg";
  write_trajectory_picture(path, winding_trajectory(50));
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  EXPECT_EQ(text.str(), trajectory_picture(winding_trajectory(50)));
  std::filesystem::remove(path);
  EXPECT_THROW(write_trajectory_picture("/nonexistent/folder/a.svg", winding_trajectory(5)), Error);
}

}  // namespace
}  // namespace ldso
