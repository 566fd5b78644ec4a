#include "io/bags/camera_info.h"

#include <gtest/gtest.h>

#include "io/bags/test_bags.h"
#include "io/datasets/test_sequences.h"
#include "ldso/error.h"

namespace ldso {
namespace {

constexpr const char* kInfo = "sensor_msgs/CameraInfo";

class CameraInfoTest : public testing::Test {
 protected:
  std::optional<Calibration> find(const std::vector<std::pair<std::string, TestInfo>>& infos,
                                  const std::string& topic = "/cam/image_raw", const std::string& frame = "camera") {
    warnings_.clear();
    std::vector<TestMessage> messages;
    for (const auto& [name, info] : infos)
      messages.push_back({name, kInfo, 1, info_message(info, MessageFormat::kCdr)});
    write_mcap(folder_ / "a.mcap", messages);
    return find_camera_info(*open_bag(folder_ / "a.mcap"), "a.mcap", topic, frame, warnings_);
  }

  TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

TEST_F(CameraInfoTest, BesideTheImagesIsTheirCamera) {
  TestInfo left;
  left.distortion = {-0.2, 0.1, 0.001, 0.002, 0.01};
  TestInfo right;
  right.fx = 50;
  const std::optional<Calibration> found = find({{"/right/camera_info", right}, {"/cam/camera_info", left}});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->camera.model, CameraModelKind::kRadTan);
  EXPECT_EQ(found->camera.width, 32);
  EXPECT_EQ(found->camera.fx, 40);
  EXPECT_EQ(found->camera.fy, 41);
  EXPECT_EQ(found->camera.distortion[3], 0.002);
  EXPECT_EQ(found->camera.more_distortion[0], 0.01);
  EXPECT_EQ(found->rectification.mode, RectificationMode::kCrop);
  EXPECT_NE(found->description.find("a.mcap:/cam/camera_info"), std::string::npos) << found->description;
}

TEST_F(CameraInfoTest, IsFoundByTheFrameOfItsCameraOtherwise) {
  TestInfo left, right;
  left.frame = "left";
  right.frame = "right";
  right.fx = 50;
  EXPECT_EQ(find({{"/a", left}, {"/b", right}}, "/x", "right")->camera.fx, 50);
  EXPECT_FALSE(find({{"/a", left}, {"/b", right}}, "/x", "middle"));
  EXPECT_FALSE(find({{"/a", left}, {"/b", left}}, "/x", "left"));
  EXPECT_FALSE(find({{"/a", left}}, "/x", ""));
}

TEST_F(CameraInfoTest, OfRectifiedImagesIsTheRectifiedCamera) {
  TestInfo info;
  info.distortion = {-0.2, 0.1, 0.001, 0.002, 0.01};
  const std::optional<Calibration> found = find({{"/cam/camera_info", info}}, "/cam/image_rect_color");
  EXPECT_EQ(found->camera.model, CameraModelKind::kPinhole);
  EXPECT_EQ(found->camera.fx, 38);
}

TEST_F(CameraInfoTest, BinningAndRegionAreOfTheWholeSensor) {
  TestInfo info;
  info.width = 64;
  info.height = 48;
  info.cx = 31.5;
  info.cy = 23.5;
  info.binning = 2;
  CameraCalibration camera = find({{"/cam/camera_info", info}})->camera;
  EXPECT_EQ(camera.width, 32);
  EXPECT_EQ(camera.fx, 20);
  EXPECT_EQ(camera.cx, 15.5);
  EXPECT_EQ(camera.cy, 11.5);
  info.binning = 0;
  info.roi_x = 10;
  info.roi_y = 8;
  info.roi_width = 40;
  info.roi_height = 32;
  camera = find({{"/cam/camera_info", info}})->camera;
  EXPECT_EQ(camera.width, 40);
  EXPECT_EQ(camera.height, 32);
  EXPECT_EQ(camera.fx, 40);
  EXPECT_EQ(camera.cx, 21.5);
  EXPECT_EQ(camera.cy, 15.5);
}

TEST_F(CameraInfoTest, OfACameraThatWasNotCalibratedIsNone) {
  TestInfo info;
  info.fx = 0;
  EXPECT_FALSE(find({{"/cam/camera_info", info}}));
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find("not calibrated"), std::string::npos);
}

TEST_F(CameraInfoTest, ThatChangesIsSaid) {
  TestInfo later;
  later.fx = 42;
  EXPECT_EQ(find({{"/cam/camera_info", TestInfo{}}, {"/cam/camera_info", later}})->camera.fx, 40);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find("changes"), std::string::npos);
}

TEST_F(CameraInfoTest, OfNonsenseIsAnError) {
  TestInfo info;
  info.model = "spline";
  info.distortion = {1, 2};
  EXPECT_NE(error_of([&] { find({{"/cam/camera_info", info}}); }).find("spline"), std::string::npos);
  info = {};
  info.fx = -3;
  EXPECT_NE(error_of([&] { find({{"/cam/camera_info", info}}); }).find("focal length"), std::string::npos);
  info = {};
  info.width = 0;
  EXPECT_NE(error_of([&] { find({{"/cam/camera_info", info}}); }).find("size"), std::string::npos);
}

TEST(BaseTopic, LacksTheTransport) {
  EXPECT_EQ(base_topic({"/cam/image_raw/compressed", "sensor_msgs/CompressedImage", MessageFormat::kCdr, 1}),
            "/cam/image_raw");
  EXPECT_EQ(base_topic({"/cam/image_raw", "sensor_msgs/Image", MessageFormat::kCdr, 1}), "/cam/image_raw");
}

}  // namespace
}  // namespace ldso
