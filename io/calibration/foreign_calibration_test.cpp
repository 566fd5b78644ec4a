#include "io/calibration/foreign_calibration.h"

#include <gtest/gtest.h>

#include "io/datasets/test_sequences.h"
#include "ldso/io/calibration_file.h"
#include "ldso/io/dataset.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;
using Coefficients = std::array<double, 4>;

class ForeignCalibration : public testing::Test {
 protected:
  Calibration read(const std::string& name, const std::string& text) const {
    write_text(folder_ / name, text);
    return read_camera_calibration(folder_ / name);
  }
  std::string error(const std::string& name, const std::string& text) const {
    return error_of([&] { read(name, text); });
  }
  static void expect_camera(const Calibration& calibration, CameraModelKind model, const Coefficients& numbers) {
    const CameraCalibration& camera = calibration.camera;
    EXPECT_EQ(camera.model, model) << calibration.description;
    EXPECT_NEAR(camera.fx, numbers[0], 1e-9) << calibration.description;
    EXPECT_NEAR(camera.fy, numbers[1], 1e-9) << calibration.description;
    EXPECT_NEAR(camera.cx, numbers[2], 1e-9) << calibration.description;
    EXPECT_NEAR(camera.cy, numbers[3], 1e-9) << calibration.description;
  }

  TemporaryFolder folder_;
};

TEST_F(ForeignCalibration, CamchainOfKalibr) {
  const Calibration radtan = read("camchain.yaml",
                                  "cam0:\n  cam_overlaps: [1]\n  camera_model: pinhole\n"
                                  "  distortion_coeffs: [-0.28, 0.07, 0.0002, 1.7e-05]\n  distortion_model: radtan\n"
                                  "  intrinsics: [458.6, 457.3, 367.2, 248.4]\n  resolution: [752, 480]\n"
                                  "  rostopic: /cam0/image_raw\ncam1:\n  camera_model: pinhole\n");
  expect_camera(radtan, CameraModelKind::kRadTan, {458.6, 457.3, 367.2, 248.4});
  EXPECT_EQ(radtan.camera.distortion, (Coefficients{-0.28, 0.07, 0.0002, 1.7e-05}));
  EXPECT_EQ(radtan.camera.width, 752);
  EXPECT_EQ(radtan.rectification.mode, RectificationMode::kCrop);
  ASSERT_EQ(radtan.warnings.size(), 1U);
  EXPECT_NE(radtan.warnings[0].find("of 2 cameras the first is taken"), std::string::npos);
  const std::string size = "  resolution: [512, 512]\n";
  const Calibration ds =
      read("ds.yaml", "cam0:\n  camera_model: ds\n  intrinsics: [-0.17, 0.59, 158.3, 158.2, 254.5, 255.2]\n" + size);
  expect_camera(ds, CameraModelKind::kDoubleSphere, {158.3, 158.2, 254.5, 255.2});
  EXPECT_EQ(ds.camera.distortion, (Coefficients{-0.17, 0.59, 0, 0}));
  const Calibration equi = read("equi.yaml",
                                "cam0:\n  camera_model: pinhole\n  distortion_model: equidistant\n  distortion_coeffs: "
                                "[0.003, 0.0007, -0.002, 0.0002]\n  intrinsics: [190.9, 190.8, 254, 256]\n" +
                                    size);
  expect_camera(equi, CameraModelKind::kKannalaBrandt, {190.9, 190.8, 254, 256});
}

TEST_F(ForeignCalibration, UnifiedCameraOfKalibrIsAnEnhancedOne) {
  // Mei: (x, y) / (z + xi |p|) times fx.
  const Calibration omni =
      read("omni.yaml",
           "cam0:\n  camera_model: omni\n  distortion_model: radtan\n  distortion_coeffs: [0, 0, 0, "
           "0]\n  intrinsics: [1.5, 475, 470, 254, 256]\n  resolution: [512, 512]\n");
  expect_camera(omni, CameraModelKind::kEucm, {190, 188, 254, 256});
  EXPECT_EQ(omni.camera.distortion, (Coefficients{0.6, 1, 0, 0}));
}

TEST_F(ForeignCalibration, CameraInfoOfRos) {
  const Calibration file = read("ost.yaml",
                                "image_width: 640\nimage_height: 480\ncamera_name: narrow_stereo\ncamera_matrix:\n  "
                                "rows: 3\n  cols: 3\n  data: [525, "
                                "0, 319.5, 0, 526, 239.5, 0, 0, 1]\ndistortion_model: "
                                "plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  "
                                "data: [0.26, -0.95, -0.0054, 0.0026, 0.3]\n");
  expect_camera(file, CameraModelKind::kRadTan, {525, 526, 319.5, 239.5});
  EXPECT_EQ(file.camera.more_distortion, (Coefficients{0.3, 0, 0, 0}));
  const Calibration message =
      read("camera_info.yaml",
           "header:\n  frame_id: camera\nheight: 480\nwidth: 640\ndistortion_model: "
           "rational_polynomial\nD: [0.1, 0.2, 0, 0, 0.3, 0.4, 0.5, 0.6]\nK: [525.0, 0.0, 319.5, "
           "0.0, 526.0, 239.5, 0.0, 0.0, 1.0]\n");
  EXPECT_EQ(message.camera.more_distortion, (Coefficients{0.3, 0.4, 0.5, 0.6}));
  const Calibration pinhole = read("k.yaml",
                                   "height: 480\nwidth: 640\ndistortion_model: plumb_bob\nd: []\nk: [525, 0, "
                                   "319.5, 0, 526, 239.5, 0, 0, 1]\n");
  expect_camera(pinhole, CameraModelKind::kPinhole, {525, 526, 319.5, 239.5});
  EXPECT_EQ(pinhole.rectification.mode, RectificationMode::kNone);
}

TEST_F(ForeignCalibration, FileStorageOfOpenCv) {
  const Calibration yaml = read(
      "calibration.yml",
      "%YAML:1.0\n---\ncalibration_time: \"today\"\nimage_width: 640\nimage_height: 480\ncamera_matrix: "
      "!!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 525., 0., 319.5, 0., 526., 239.5, 0., 0., 1. ]\n"
      "distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n   data: [ -2.8e-01, 0.07, 0., 0., "
      "0. "
      "]\n");
  expect_camera(yaml, CameraModelKind::kRadTan, {525, 526, 319.5, 239.5});
  const Calibration xml = read(
      "calibration.xml",
      "<?xml version=\"1.0\"?>\n<opencv_storage>\n<image_width>640</image_width>\n<image_height>480</image_height>\n"
      "<fisheye_model>1</fisheye_model>\n<camera_matrix type_id=\"opencv-matrix\">\n  <rows>3</rows>\n  "
      "<cols>3</cols>\n  "
      "<dt>d</dt>\n  <data>\n    325. 0. 319.5 0. 326. 239.5 0. 0. 1.</data></camera_matrix>\n<distortion_coefficients "
      "type_id=\"opencv-matrix\"><rows>4</rows><cols>1</cols><dt>d</dt><data>0.01 -0.02 0.003 4e-4</data>"
      "</distortion_coefficients>\n</opencv_storage>\n");
  expect_camera(xml, CameraModelKind::kKannalaBrandt, {325, 326, 319.5, 239.5});
  EXPECT_EQ(xml.camera.distortion, (Coefficients{0.01, -0.02, 0.003, 4e-4}));
}

TEST_F(ForeignCalibration, SettingsOfOrbSlam) {
  const Calibration first = read("TUM1.yaml",
                                 "%YAML:1.0\n\n# Camera\nCamera.fx: 517.3\nCamera.fy: 516.5\nCamera.cx: 318.6\n"
                                 "Camera.cy: 255.3\nCamera.k1: 0.26\nCamera.k2: -0.95\nCamera.p1: -0.005\nCamera.p2: "
                                 "0.0026\nCamera.k3: 1.16\nCamera.width: 640\nCamera.height: 480\nCamera.fps: 30.0\n");
  expect_camera(first, CameraModelKind::kRadTan, {517.3, 516.5, 318.6, 255.3});
  EXPECT_EQ(first.camera.more_distortion[0], 1.16);
  const Calibration third =
      read("TUM-VI.yaml",
           "%YAML:1.0\nFile.version: \"1.0\"\nCamera.type: \"KannalaBrandt8\"\nCamera1.fx: 190.9\n"
           "Camera1.fy: 190.8\nCamera1.cx: 254.9\nCamera1.cy: 256.8\nCamera1.k1: 0.003\nCamera1.k2: "
           "0.0007\nCamera1.k3: -0.002\nCamera1.k4: 0.0002\nCamera.width: 512\nCamera.height: 512\n");
  expect_camera(third, CameraModelKind::kKannalaBrandt, {190.9, 190.8, 254.9, 256.8});
  EXPECT_NE(error("old.yaml", "%YAML:1.0\nCamera.fx: 517.3\nCamera.fy: 516.5\nCamera.cx: 318.6\nCamera.cy: 255.3\n")
                .find("old.yaml:2: the size of the images is missing"),
            std::string::npos);
}

TEST_F(ForeignCalibration, CamerasOfColmapHaveTheirCentresHalfAPixelOff) {
  struct Line {
    const char* text;
    CameraModelKind model;
    Coefficients numbers, distortion;
  };
  const Line lines[] = {
      {"SIMPLE_PINHOLE 640 480 525 320 240", CameraModelKind::kPinhole, {525, 525, 319.5, 239.5}, {}},
      {"PINHOLE 640 480 525 526 320 240", CameraModelKind::kPinhole, {525, 526, 319.5, 239.5}, {}},
      {"SIMPLE_RADIAL 640 480 525 320 240 -0.1", CameraModelKind::kRadTan, {525, 525, 319.5, 239.5}, {-0.1}},
      {"RADIAL 640 480 525 320 240 -0.1 0.02", CameraModelKind::kRadTan, {525, 525, 319.5, 239.5}, {-0.1, 0.02}},
      {"OPENCV 640 480 525 526 320 240 -0.1 0.02 0.001 0.002",
       CameraModelKind::kRadTan,
       {525, 526, 319.5, 239.5},
       {-0.1, 0.02, 0.001, 0.002}},
      {"OPENCV_FISHEYE 640 480 325 326 320 240 0.01 0.02 0.03 0.04",
       CameraModelKind::kKannalaBrandt,
       {325, 326, 319.5, 239.5},
       {0.01, 0.02, 0.03, 0.04}},
      {"FOV 640 480 325 326 320 240 0.9", CameraModelKind::kFov, {325, 326, 319.5, 239.5}, {0.9}},
  };
  for (const Line& line : lines) {
    const Calibration read_line =
        read("cameras.txt", "# Camera list with one line of data per camera:\n1 " + std::string(line.text) + "\n");
    expect_camera(read_line, line.model, line.numbers);
    EXPECT_EQ(read_line.camera.distortion, line.distortion) << line.text;
  }
}

TEST_F(ForeignCalibration, OfBasaltAndOfNerfstudio) {
  const Calibration basalt = read(
      "calibration.json",
      R"({"value0": {"T_imu_cam": [], "intrinsics": [{"camera_type": "ds", "intrinsics": {"fx": 158.2, "fy": 158.3, "cx":
      254.5, "cy": 255.2, "xi": -0.17, "alpha": 0.59}}], "resolution": [[512, 512]]}})");
  expect_camera(basalt, CameraModelKind::kDoubleSphere, {158.2, 158.3, 254.5, 255.2});
  const Calibration transforms = read("transforms.json",
                                      R"({"camera_model": "OPENCV", "w": 640, "h": 480, "fl_x": 525, "fl_y": 526,
      "cx": 320, "cy": 240, "k1": -0.1, "k2": 0.02, "p1": 0.001, "p2": 0.002, "frames": []})");
  expect_camera(transforms, CameraModelKind::kRadTan, {525, 526, 319.5, 239.5});
  EXPECT_EQ(transforms.camera.distortion, (Coefficients{-0.1, 0.02, 0.001, 0.002}));
  const Calibration angle = read("transforms.json", R"({"camera_angle_x": 1.5707963267948966, "w": 640, "h": 480})");
  expect_camera(angle, CameraModelKind::kPinhole, {320, 320, 319.5, 239.5});
}

TEST_F(ForeignCalibration, OfKittisRawData) {
  const Calibration raw =
      read("calib_cam_to_cam.txt",
           "calib_time: 09-Jan-2012 13:57:47\nS_00: 1.392e+03 5.12e+02\nS_rect_00: 1.242e+03 3.75e+02\n"
           "P_rect_00: 721.5 0 609.6 0 0 721.6 172.9 0 0 0 1 0\n");
  expect_camera(raw, CameraModelKind::kPinhole, {721.5, 721.6, 609.6, 172.9});
  EXPECT_EQ(raw.camera.height, 375);
}

TEST_F(ForeignCalibration, OneOfSeveralCamerasCanBeChosen) {
  const auto cam = [](int focal) {
    return "  camera_model: pinhole\n  intrinsics: [" + std::to_string(focal) +
           ", 457, 367, 248]\n  resolution: [752, 480]\n";
  };
  write_text(folder_ / "camchain.yaml", "cam0:\n" + cam(450) + "cam1:\n" + cam(460));
  write_text(folder_ / "cameras.txt", "1 PINHOLE 640 480 525 526 320 240\n7 PINHOLE 640 480 535 536 320 240\n");
  const auto focal = [&](const char* name) { return read_camera_calibration(folder_ / name).camera.fx; };
  EXPECT_EQ(focal("camchain.yaml"), 450);
  EXPECT_EQ(focal("camchain.yaml:cam0"), 450);
  EXPECT_EQ(focal("camchain.yaml:cam1"), 460);
  EXPECT_EQ(focal("camchain.yaml:1"), 460);
  EXPECT_EQ(focal("cameras.txt:1"), 535);
  EXPECT_TRUE(read_camera_calibration(folder_ / "camchain.yaml:1").warnings.empty());
  EXPECT_NE(error_of([&] { focal("camchain.yaml:2"); }).find("there is no camera 2; its cameras are 0 to 1"),
            std::string::npos);
  write_text(folder_ / "camera.txt", kTestCamera);
  EXPECT_NE(error_of([&] { focal("camera.txt:1"); }).find("holds one camera"), std::string::npos);
  write_text(folder_ / "odd:1", kTestCamera);
  EXPECT_EQ(focal("odd:1"), 40);

  make_image_folder(folder_ / "sequence", 2);
  write_text(folder_ / "two.txt", "1 PINHOLE 32 24 40 41 16 12\n2 PINHOLE 32 24 50 51 16 12\n");
  DatasetOptions options;
  options.calibration_file = folder_ / "two.txt:1";
  EXPECT_EQ(open_dataset(folder_ / "sequence", options)->calibration().camera.fx, 50);
}

TEST_F(ForeignCalibration, ThatCannotBeUsedIsAnErrorThatNamesIt) {
  const auto expect = [&](const std::string& name, const std::string& text, const std::string& complaint) {
    const std::string message = error(name, text);
    EXPECT_NE(message.find(name), std::string::npos) << message;
    EXPECT_NE(message.find(complaint), std::string::npos) << message;
  };
  expect("a.yaml", "a: 1\n", "is no calibration of a known kind");
  expect("a.yaml", "cam0: {camera_model: pinhole, intrinsics: [1, 2, 3]}\n", "list of 4 numbers");
  expect("a.yaml",
         "cam0: {camera_model: pinhole, distortion_model: magic, distortion_coeffs: [1], intrinsics: [525, 525, 320, "
         "240], resolution: [640, 480]}\n",
         "the lens model 'magic' is unknown");
  expect("a.yaml", "camera_matrix: {data: [1, 2]}\nimage_width: 640\nimage_height: 480\n", "has 2 numbers");
  expect("a.yaml", "camera_matrix: {data: [525, 0, 320, 0, 525, 240, 0, 0, 1]}\n", "size of the images is missing");
  expect("a.json", "{\"value0\": {}}", "is damaged or lacks a value");
  expect("a.json", "{\"frames\": []}", "is no calibration of a known kind");
  expect("a.json", "{", "is damaged or lacks a value");
  expect("a.xml", "<opencv_storage></opencv_storage>", "has no camera_matrix");
  expect("cameras.txt", "1 THIN_PRISM_FISHEYE 640 480 1 2 3 4 5 6 7\n", "'THIN_PRISM_FISHEYE' is unknown here");
  expect("cameras.txt", "1 OPENCV 640 480 525 526 320 240 0.1\n", "has 1 coefficients");
  expect("cameras.txt", "1 PINHOLE 640 480 525 320 526 240\n", "look like `fx cx fy cy`");
}

TEST_F(ForeignCalibration, BesideTheImagesIsFound) {
  EXPECT_EQ(find_calibration(folder_.path()), folder_ / "camera.txt");
  make_tum_mono(folder_.path(), 2);
  fs::remove(folder_ / "camera.txt");
  write_text(folder_ / "cameras.txt", "1 PINHOLE 32 24 40 41 16 12\n");
  const auto dataset = open_dataset(folder_.path());
  EXPECT_EQ(dataset->calibration().camera.cx, 15.5);
  EXPECT_NE(dataset->calibration().description.find("COLMAP cameras, PINHOLE"), std::string::npos);
}

}  // namespace
}  // namespace ldso
