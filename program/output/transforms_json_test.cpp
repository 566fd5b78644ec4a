#include "output/transforms_json.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "ldso/error.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

ColmapModel model_of_lens(CameraModelKind kind) {
  ColmapModel model;
  model.camera = {kind, 640, 480, 500, 510, 319.5, 239.5, {0.1, 0.2, 0.3, 0.4}};
  model.images = {{"a.png", SE3d(SO3d(), {1, 2, 3}), {}}, {"b.png", SE3d(SO3d(), {3, 2, 4}), {}}};
  return model;
}

nlohmann::json written(const ColmapModel& model) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "ldso_transforms_test.json";
  write_transforms_json(path, model, "images", "points.ply");
  nlohmann::json json = nlohmann::json::parse(read_file(path));
  std::filesystem::remove(path);
  return json;
}

TEST(TransformsJson, HasPosesOfCamerasThatLookAlongMinusZ) {
  const nlohmann::json json = written(model_of_lens(CameraModelKind::kPinhole));
  EXPECT_EQ(json["w"], 640);
  EXPECT_EQ(json["fl_y"], 510);
  EXPECT_EQ(json["cx"], 320);
  EXPECT_EQ(json["k1"], 0);
  EXPECT_EQ(json["ply_file_path"], "points.ply");
  ASSERT_EQ(json["frames"].size(), 2U);
  EXPECT_EQ(json["frames"][1]["file_path"], "images/b.png");
  const nlohmann::json rows = {{1., 0., 0., 1.}, {0., -1., 0., 2.}, {0., 0., -1., 3.}, {0., 0., 0., 1.}};
  EXPECT_EQ(json["frames"][0]["transform_matrix"], rows);
}

TEST(TransformsJson, CamerasLieInTheUnitCube) {
  const nlohmann::json json = written(model_of_lens(CameraModelKind::kPinhole));
  const double scale = json["scale"];
  EXPECT_EQ(scale, 0.5) << "they are two apart";
  EXPECT_EQ(1 * scale + double(json["offset"][0]), 0);
  EXPECT_EQ(3 * scale + double(json["offset"][0]), 1);
  EXPECT_EQ(2 * scale + double(json["offset"][1]), 0.5);
}

TEST(TransformsJson, LensesThatItDoesNotKnowAreRefused) {
  EXPECT_EQ(written(model_of_lens(CameraModelKind::kRadTan))["k2"], 0.2);
  EXPECT_EQ(written(model_of_lens(CameraModelKind::kKannalaBrandt))["camera_model"], "OPENCV_FISHEYE");
  EXPECT_FALSE(has_transforms_lens(model_of_lens(CameraModelKind::kFov).camera));
  EXPECT_THROW(written(model_of_lens(CameraModelKind::kFov)), Error);
}

}  // namespace
}  // namespace ldso
