#include "io/datasets/euroc_dataset.h"

#include <gtest/gtest.h>

#include "io/datasets/test_sequences.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

TEST(EurocDataset, CarriesCalibrationAndGroundTruthOfTheCamera) {
  const TemporaryFolder folder;
  const auto dataset = open_euroc(make_euroc(folder.path(), 4), {});
  const Calibration& calibration = dataset->calibration();
  EXPECT_EQ(calibration.camera.model, CameraModelKind::kRadTan);
  EXPECT_EQ(calibration.camera.fy, 41);
  EXPECT_EQ(calibration.camera.distortion[0], -0.28);
  EXPECT_EQ(calibration.rectification.mode, RectificationMode::kCrop);
  const auto truth = dataset->ground_truth();
  ASSERT_TRUE(truth.has_value());
  const SE3d& T_world_camera = truth->at(3).T_world_camera;
  EXPECT_TRUE(T_world_camera.translation().isApprox(Eigen::Vector3d(3, 0, 0), 1e-12));
  EXPECT_TRUE((T_world_camera.rotation() * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(0, 1, 0), 1e-12));
  EXPECT_EQ(truth->at(3).timestamp, dataset->timestamp(3));
}

TEST(EurocDataset, OpensMav0ItselfToo) {
  const TemporaryFolder folder;
  EXPECT_EQ(open_dataset(make_euroc(folder.path(), 3) / "mav0")->size(), 3);
}

TEST(EurocDataset, GroundTruthIsOptional) {
  const TemporaryFolder folder;
  make_euroc(folder.path(), 2);
  fs::remove_all(folder / "mav0/state_groundtruth_estimate0");
  EXPECT_FALSE(open_euroc(folder.path(), {})->ground_truth().has_value());
}

TEST(EurocDataset, BadSensorFilesAreErrors) {
  const TemporaryFolder folder;
  make_euroc(folder.path(), 2);
  const fs::path sensor = folder / "mav0/cam0/sensor.yaml";
  const auto message_for = [&](const std::string& text) {
    write_text(sensor, text);
    return error_of([&] { open_euroc(folder.path(), {}); });
  };
  EXPECT_NE(message_for("a: [1, 2\nb: 3\n").find("sensor.yaml:"), std::string::npos);
  EXPECT_NE(message_for("just text").find("not a sensor description"), std::string::npos);
  EXPECT_NE(message_for("intrinsics: [1, 2, 3, 4]\n").find("'resolution'"), std::string::npos);
  EXPECT_NE(message_for("resolution: [32, 24]\nintrinsics: [1, 2, 3]\n").find("list of 4 numbers"), std::string::npos);
  EXPECT_NE(message_for("distortion_model: magic\n").find("'magic'"), std::string::npos);
  EXPECT_NE(message_for("resolution: [32, 24]\nintrinsics: [1, 2, 3, 4]\n").find("'T_BS'"), std::string::npos);
  const std::string numbers = "resolution: [32, 24]\nintrinsics: [1, 2, 3, 4]\n";
  EXPECT_NE(message_for(numbers + "T_BS: {rows: 4}\n").find("sensor.yaml:3: 'T_BS' has no 'data'"), std::string::npos);
  EXPECT_NE(message_for(numbers + "T_BS: {data: [1,0,0,0, 0,2,0,0, 0,0,1,0, 0,0,0,1]}\n").find("no rigid motion"),
            std::string::npos);
  for (const char* size : {"1e300, 1e300", "100000, 100000", "0, 24", "32.5, 24", "-32, 24"}) {
    EXPECT_NE(message_for("resolution: [" + std::string(size) + "]\n").find("is no image size"), std::string::npos);
  }
  EXPECT_NE(message_for("resolution: [32, 24]\nintrinsics: [0, 1, 2, 3]\n").find("focal length"), std::string::npos);
  EXPECT_NE(message_for("resolution: [32, nan]\n").find("sensor.yaml:1: 'resolution' is 'nan'"), std::string::npos);
}

TEST(EurocDataset, BadListOfImagesIsAnError) {
  const TemporaryFolder folder;
  make_euroc(folder.path(), 2);
  write_text(folder / "mav0/cam0/data.csv", "#timestamp [ns],filename\n14.5,a.png\n");
  EXPECT_NE(error_of([&] { open_euroc(folder.path(), {}); }).find("data.csv:2"), std::string::npos);
  write_text(folder / "mav0/cam0/data.csv", "#timestamp [ns],filename\n");
  EXPECT_NE(error_of([&] { open_euroc(folder.path(), {}); }).find("there are no images"), std::string::npos);
}

TEST(EurocDataset, WithoutSensorFileNeedsACalibration) {
  const TemporaryFolder folder;
  make_euroc(folder.path(), 2);
  fs::remove(folder / "mav0/cam0/sensor.yaml");
  EXPECT_NE(error_of([&] { open_euroc(folder.path(), {}); }).find("--calib"), std::string::npos);
}

}  // namespace
}  // namespace ldso
