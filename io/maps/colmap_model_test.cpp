#include "ldso/io/colmap_model.h"

#include <gtest/gtest.h>

#include "ldso/error.h"

#include "io/datasets/test_sequences.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

TEST(ColmapModel, CamerasKeepTheirLensAndMoveTheirPixelCentresByAHalf) {
  CameraCalibration camera{CameraModelKind::kPinhole, 640, 480, 500, 510, 319.5, 239.5, {0.1, 0.2, 0.3, 0.4}};
  EXPECT_EQ(colmap_camera(camera), "PINHOLE 640 480 500 510 320 240");
  camera.model = CameraModelKind::kFov;
  EXPECT_EQ(colmap_camera(camera), "FOV 640 480 500 510 320 240 0.1");
  camera.model = CameraModelKind::kRadTan;
  EXPECT_EQ(colmap_camera(camera), "OPENCV 640 480 500 510 320 240 0.1 0.2 0.3 0.4");
  camera.model = CameraModelKind::kKannalaBrandt;
  EXPECT_EQ(colmap_camera(camera), "OPENCV_FISHEYE 640 480 500 510 320 240 0.1 0.2 0.3 0.4");
}

ColmapModel two_images() {
  ColmapModel model;
  model.camera = {CameraModelKind::kPinhole, 640, 480, 500, 500, 319.5, 239.5, {}};
  model.points = {{{1, 2, 3}, 10}, {{4, 5, 6}, 20}, {{7, 8, 9}, 30, Rgb{1, 2, 3}, 0.25}};
  model.images = {{"a.png", SE3d(SO3d(), {1, 0, 0}), {{{10, 20}, 0}, {{30.25, 40}, 2}}},
                  {"b.png", SE3d(), {{{5, 6}, 2}}}};
  return model;
}

TEST(ColmapModel, TracksAndObservationsNameEachOther) {
  const TemporaryFolder folder;
  write_colmap_model(folder / "sparse/0", two_images());
  EXPECT_EQ(read_file(folder / "sparse/0/cameras.txt"),
            "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS\n1 PINHOLE 640 480 500 500 320 240\n");
  const std::string images = read_file(folder / "sparse/0/images.txt");
  EXPECT_EQ(images.substr(images.find('\n') + 1),
            "1 1 0 0 0 -1 0 0 1 a.png\n10.500 20.500 1 30.750 40.500 3\n2 1 0 0 0 0 0 0 1 b.png\n5.500 6.500 3\n");
  const std::string points = read_file(folder / "sparse/0/points3D.txt");
  EXPECT_EQ(points.substr(points.find('\n') + 1), "1 1 2 3 10 10 10 -1 1 0\n3 7 8 9 1 2 3 0.25 1 1 2 0\n");
}

TEST(ColmapModel, BinaryFilesHaveTheBytesThatTheFormatAsksFor) {
  const TemporaryFolder folder;
  write_colmap_model(folder.path(), two_images());
  const std::string cameras = read_file(folder / "cameras.bin");
  ASSERT_EQ(cameras.size(), 8U + 4 + 4 + 8 + 8 + 4 * 8);
  EXPECT_TRUE(cameras.starts_with(std::string("\1\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0\x80\2\0\0\0\0\0\0", 24)));
  const std::string images = read_file(folder / "images.bin");
  ASSERT_EQ(images.size(), 8U + 2 * (4 + 7 * 8 + 4 + 6 + 8) + 3 * 24);
  EXPECT_EQ(images.substr(8 + 4 + 56 + 4, 6), std::string("a.png\0", 6));
  const std::string points = read_file(folder / "points3D.bin");
  ASSERT_EQ(points.size(), 8U + 2 * (8 + 24 + 3 + 8 + 8) + 3 * 8) << "the point that no image shows is not in it";
  EXPECT_EQ(points.substr(points.size() - 59, 8), std::string("\0\0\0\0\0\0\x1c\x40", 8)) << "x is 7";
  EXPECT_EQ(points.substr(points.size() - 35, 3), std::string("\1\2\3"));
  EXPECT_EQ(points.substr(points.size() - 32, 8), std::string("\0\0\0\0\0\0\xd0\x3f", 8)) << "the error is 0.25";
  EXPECT_EQ(points.substr(points.size() - 16), std::string("\1\0\0\0\1\0\0\0\2\0\0\0\0\0\0\0", 16));
}

TEST(ColmapModel, NamesThatTheFormatCannotHoldAreRefused) {
  const TemporaryFolder folder;
  ColmapModel model = two_images();
  model.images[1].name = "a b.png";
  EXPECT_THROW(write_colmap_model(folder / "sparse", model), Error);
}

TEST(ColmapModel, LensWithMoreCoefficientsIsTheFullOne) {
  CameraCalibration camera;
  camera.model = CameraModelKind::kRadTan;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 500;
  camera.cx = 319.5;
  camera.cy = 239.5;
  camera.distortion = {0.1, 0.2, 0.3, 0.4};
  camera.more_distortion = {0.5, 0, 0, 0};
  EXPECT_EQ(colmap_camera(camera), "FULL_OPENCV 640 480 500 500 320 240 0.1 0.2 0.3 0.4 0.5 0 0 0");
  camera.model = CameraModelKind::kEucm;
  EXPECT_THROW(colmap_camera(camera), Error);
}

}  // namespace
}  // namespace ldso
