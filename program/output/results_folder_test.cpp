#include "ldso/results_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ldso/error.h"
#include "ldso/io/ply_file.h"
#include "ldso/io/trajectory_file.h"
#include "output/finished_run.h"
#include "slam/test_scene.h"
#include "viewer/recording/recorded_map.h"
#include "viewer/recording/recording_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 30;

class ResultsFolderTest : public testing::Test {
 protected:
  void SetUp() override { fs::remove_all(folder); }
  void TearDown() override { fs::remove_all(folder); }

  static SlamResult track(Slam& slam) {
    for (int i = 0; i < kFrames; ++i) slam.process(draw_scene(i).view(), 0.1 * i);
    return slam.finish();
  }

  const fs::path folder = fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(ResultsFolderTest, HoldsWhatViewAndExportRead) {
  const Settings settings;
  ResultsFolder results(folder, scene_calibration(), settings, {.name = "boards"});
  Slam slam(scene_calibration(), settings, results.log(), results.observer());
  const SlamResult result = track(slam);
  results.write(result);

  EXPECT_EQ(read_tum_trajectory(folder / "trajectory.txt").size(), result.trajectory().size());
  EXPECT_EQ(read_ply(folder / "map.ply").size(), result.points().size());
  const RecordedMap map = read_recorded_map(folder / kRecordingName);
  EXPECT_EQ(map.keyframes.size(), result.keyframes.size());
  const FinishedRun run = read_finished_run(folder);
  EXPECT_EQ(run.camera.width, kSceneWidth);
  EXPECT_THROW(open_sequence(run), Error);
  EXPECT_TRUE(fs::exists(folder / "report.html"));
}

TEST_F(ResultsFolderTest, KeepsTheWarningsAndPassesThemOn) {
  std::vector<std::string> heard;
  ResultsFolder results(folder, scene_calibration(), Settings{},
                        {.log = [&](LogLevel, const std::string& text) { heard.push_back(text); }});
  results.log()(LogLevel::kInfo, "all is well");
  results.log()(LogLevel::kWarning, "something is odd");
  results.write(SlamResult{});
  EXPECT_EQ(heard.size(), 2u);
  std::ifstream file(folder / "run.json");
  const nlohmann::json json = nlohmann::json::parse(file);
  EXPECT_EQ(json["warnings"], nlohmann::json({"something is odd"}));
  EXPECT_EQ(json["sequence"]["format"], "frames of a program");
}

TEST_F(ResultsFolderTest, TouchesNoFileOfOthers) {
  fs::create_directories(folder);
  std::ofstream(folder / "trajectory.txt") << "mine\n";
  EXPECT_THROW(ResultsFolder(folder, scene_calibration(), Settings{}), Error);
  std::string line;
  std::getline(std::ifstream(folder / "trajectory.txt"), line);
  EXPECT_EQ(line, "mine");
}

}  // namespace
}  // namespace ldso
