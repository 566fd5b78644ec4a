#include "results/loop_pictures.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "io/images/image_file.h"
#include "io/images/match_picture.h"
#include "ldso/error.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 64, kHeight = 48;

/// Frame i is grey all over, 100 + 10 i; frame 3 cannot be read.
class GreyDataset final : public Dataset {
 public:
  explicit GreyDataset(bool with_response = false) {
    calibration_.camera.width = kWidth;
    calibration_.camera.height = kHeight;
    calibration_.camera.fx = calibration_.camera.fy = 50;
    calibration_.camera.cx = 31.5;
    calibration_.camera.cy = 23.5;
    if (!with_response) return;
    auto& response = calibration_.photometric.inverse_response.emplace();
    for (std::size_t i = 0; i < response.size(); ++i) response[i] = static_cast<float>(i * i) / 255;
  }

  int size() const override { return 5; }
  RawFrame read(int index) const override {
    if (index == 3) throw Error("frame 3", "is damaged", "copy it again");
    RawFrame frame;
    frame.id = index;
    frame.grey = Image<float>(kWidth, kHeight, static_cast<float>(100 + 10 * index));
    return frame;
  }
  double timestamp(int index) const override { return index; }
  const Calibration& calibration() const override { return calibration_; }
  std::optional<Trajectory> ground_truth() const override { return {}; }
  std::string format_name() const override { return "grey"; }
  const std::vector<std::string>& warnings() const override { return warnings_; }

 private:
  Calibration calibration_;
  std::vector<std::string> warnings_;
};

class LoopPictures : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("ldso_" + std::to_string(getpid()) + test->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static LoopRecord loop(int keyframe, int candidate, bool accepted = true) {
    LoopRecord record;
    record.keyframe_id = keyframe;
    record.candidate_id = candidate;
    record.accepted = accepted;
    record.matches = {{10, 20, 40, 20}};
    return record;
  }

  /// Grey level of the picture's corner pixels, left and right.
  std::pair<int, int> levels(const fs::path& path) const {
    const Image<float> picture = read_grey_image(path);
    return {std::lround(picture(2, 2)), std::lround(picture(kWidth + 2, 2))};
  }

  fs::path folder_;
};

TEST_F(LoopPictures, ShowTheCandidateLeftAndTheKeyframeRight) {
  const std::vector<LoopRecord> loops{loop(4, 1)};
  EXPECT_TRUE(write_loop_pictures(folder_, loops, GreyDataset(), GreyDataset().calibration(), {}).empty());
  const fs::path path = folder_ / "loops" / "4_1.png";
  const Image<float> picture = read_grey_image(path);
  EXPECT_EQ(picture.width(), 2 * kWidth);
  EXPECT_EQ(picture.height(), kHeight + caption_height("x"));
  EXPECT_EQ(levels(path), std::make_pair(110, 140));
  EXPECT_NE(std::lround(picture(kWidth / 2, 20)), 110) << "the line of the match";
}

TEST_F(LoopPictures, LinearIntensitiesAreBrightened) {
  const std::vector<LoopRecord> loops{loop(4, 1)};
  EXPECT_TRUE(write_loop_pictures(folder_, loops, GreyDataset(true), GreyDataset().calibration(), {}).empty());
  const auto [left, right] = levels(folder_ / "loops" / "4_1.png");
  EXPECT_NEAR(left, 110, 1);  // The response is a square: its inverse is what people see.
  EXPECT_NEAR(right, 140, 1);
}

TEST_F(LoopPictures, AreOfAcceptedLoopsOnly) {
  const std::vector<LoopRecord> loops{loop(4, 1), loop(2, 0, false), loop(4, 0)};
  EXPECT_TRUE(write_loop_pictures(folder_, loops, GreyDataset(), GreyDataset().calibration(), {}).empty());
  EXPECT_TRUE(fs::exists(folder_ / "loops" / "4_0.png"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "loops"), {}), 2);
}

TEST_F(LoopPictures, AFrameThatCannotBeReadAgainIsAWarning) {
  const std::vector<LoopRecord> loops{loop(3, 1), loop(9, 1), loop(4, 2)};
  const std::vector<std::string> warnings =
      write_loop_pictures(folder_, loops, GreyDataset(), GreyDataset().calibration(), {});
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_NE(warnings[0].find("frame 3 to frame 1: frame 3"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("is damaged"), std::string::npos);
  EXPECT_NE(warnings[1].find("is not in the sequence"), std::string::npos) << warnings[1];
  EXPECT_TRUE(fs::exists(folder_ / "loops" / "4_2.png")) << "the next one is drawn";
}

TEST_F(LoopPictures, AFolderThatCannotBeMadeIsAWarning) {
  std::ofstream(folder_ / "loops") << "a file\n";
  const std::vector<LoopRecord> loops{loop(4, 1)};
  EXPECT_EQ(write_loop_pictures(folder_, loops, GreyDataset(), GreyDataset().calibration(), {}).size(), 1U);
}

TEST_F(LoopPictures, RemovesItsOwnPicturesOnly) {
  remove_loop_pictures(folder_);  // Nothing there.
  const std::vector<LoopRecord> loops{loop(4, 1)};
  write_loop_pictures(folder_, loops, GreyDataset(), GreyDataset().calibration(), {});
  remove_loop_pictures(folder_);
  EXPECT_TRUE(fs::is_empty(folder_ / "loops"));
  write_loop_pictures(folder_, loops, GreyDataset(), GreyDataset().calibration(), {});
  std::ofstream(folder_ / "loops" / "notes.txt") << "mine\n";
  remove_loop_pictures(folder_);
  EXPECT_FALSE(fs::exists(folder_ / "loops" / "4_1.png"));
  EXPECT_TRUE(fs::exists(folder_ / "loops" / "notes.txt"));
}

TEST(LoopCaption, NamesBothAndTheScale) {
  LoopRecord loop;
  loop.keyframe_id = 912;
  loop.candidate_id = 31;
  loop.inliers = 140;
  loop.depth_inliers = 90;
  loop.S_keyframe_candidate = Sim3d(SO3d::exp({0, 0.5, 0}), {0, 0, 0}, 1.25);
  loop.log_scale_stddev = 0.01;
  EXPECT_EQ(loop_caption(loop),
            "candidate 31 (left), keyframe 912 (right): 140 inliers, 90 with depth; scale 1.2500 +- 0.0125, "
            "rotation 28.65 deg");
}

}  // namespace
}  // namespace ldso
