#include "ldso/io/calibration_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "io/datasets/test_sequences.h"
#include "io/images/image_file.h"

namespace ldso {
namespace {

class CameraFile : public testing::Test {
 protected:
  Calibration read(const std::string& text) const {
    write_text(folder_ / "camera.txt", text);
    return read_camera_calibration(folder_ / "camera.txt");
  }
  std::string error(const std::string& text) const {
    return error_of([&] { read(text); });
  }

  TemporaryFolder folder_;
};

TEST_F(CameraFile, FiveRelativeNumbersAreFov) {
  const Calibration c = read("0.349153 0.436593 0.493140 0.499021 0.933271\n1280 1024\ncrop\n640 480\n");
  EXPECT_EQ(c.camera.model, CameraModelKind::kFov);
  EXPECT_EQ(c.camera.width, 1280);
  EXPECT_EQ(c.camera.height, 1024);
  EXPECT_DOUBLE_EQ(c.camera.fx, 0.349153 * 1280);
  EXPECT_DOUBLE_EQ(c.camera.fy, 0.436593 * 1024);
  EXPECT_DOUBLE_EQ(c.camera.cx, 0.493140 * 1280 - 0.5);
  EXPECT_DOUBLE_EQ(c.camera.cy, 0.499021 * 1024 - 0.5);
  EXPECT_DOUBLE_EQ(c.camera.distortion[0], 0.933271);
  EXPECT_EQ(c.rectification.mode, RectificationMode::kCrop);
  EXPECT_EQ(c.rectification.width, 640);
  EXPECT_EQ(c.rectification.height, 480);
  EXPECT_NE(c.description.find("relative"), std::string::npos);
}

TEST_F(CameraFile, AbsoluteNumbersArePixels) {
  const Calibration c = read("FOV 500 501 319.5 239.5 0.9\n640 480\nfull\n800 600\n");
  EXPECT_EQ(c.camera.model, CameraModelKind::kFov);
  EXPECT_DOUBLE_EQ(c.camera.fx, 500);
  EXPECT_DOUBLE_EQ(c.camera.cx, 319.5);
  EXPECT_EQ(c.rectification.mode, RectificationMode::kFull);
  EXPECT_NE(c.description.find("absolute"), std::string::npos);
}

TEST_F(CameraFile, PinholeWithNonePassesThrough) {
  const Calibration c = read("Pinhole 525 525 319.5 239.5 0\n640 480\nnone\n640 480\n");
  EXPECT_EQ(c.camera.model, CameraModelKind::kPinhole);
  EXPECT_EQ(c.rectification.mode, RectificationMode::kNone);
  EXPECT_EQ(read("525 525 319.5 239.5 0\n640 480\nnone\n640 480\n").camera.model, CameraModelKind::kPinhole);
}

TEST_F(CameraFile, NamedModelsTakeTheirParameters) {
  const Calibration r = read("RadTan 458 457 367 248 -0.28 0.07 0.0002 1.7e-05\n752 480\ncrop\n752 480\n");
  EXPECT_EQ(r.camera.model, CameraModelKind::kRadTan);
  EXPECT_EQ(r.camera.distortion, (std::array<double, 4>{-0.28, 0.07, 0.0002, 1.7e-05}));
  for (const char* name : {"KannalaBrandt", "EquiDistant", "equidistant"}) {
    const Calibration k =
        read(std::string(name) + " 190 190 254 256 0.003 0.0007 -0.002 0.0002\n512 512\ncrop\n512 512\n");
    EXPECT_EQ(k.camera.model, CameraModelKind::kKannalaBrandt);
    EXPECT_EQ(k.camera.distortion, (std::array<double, 4>{0.003, 0.0007, -0.002, 0.0002}));
  }
}

TEST_F(CameraFile, RadTanMayHaveFiveOrEightCoefficients) {
  const Calibration five = read("RadTan 525 526 319.5 239.5 0.1 -0.2 0.003 0.004 0.05\n640 480\ncrop\n640 480\n");
  EXPECT_EQ(five.camera.distortion, (std::array<double, 4>{0.1, -0.2, 0.003, 0.004}));
  EXPECT_EQ(five.camera.more_distortion, (std::array<double, 4>{0.05, 0, 0, 0}));
  const Calibration eight =
      read("RadTan 525 526 319.5 239.5 0.1 -0.2 0.003 0.004 0.05 0.06 0.07 0.08\n640 480\ncrop\n640 480\n");
  EXPECT_EQ(eight.camera.more_distortion, (std::array<double, 4>{0.05, 0.06, 0.07, 0.08}));
  const Calibration again = read(camera_file_text(eight));
  EXPECT_EQ(again.camera.more_distortion, eight.camera.more_distortion);
  EXPECT_NE(error("RadTan 525 526 319.5 239.5 0.1 -0.2 0.003 0.004 0.05 0.06\n640 480\ncrop\n640 480\n")
                .find("has 10 numbers; expected `RadTan fx fy cx cy k1 k2 p1 p2`"),
            std::string::npos);
}

TEST_F(CameraFile, SpheresAreReadAndWritten) {
  const Calibration ds = read("DoubleSphere 158 158 254.5 255.2 -0.17 0.59\n512 512\ncrop\n512 512\n");
  EXPECT_EQ(ds.camera.model, CameraModelKind::kDoubleSphere);
  EXPECT_EQ(read(camera_file_text(ds)).camera.distortion, (std::array<double, 4>{-0.17, 0.59, 0, 0}));
  EXPECT_EQ(read("EUCM 190 190 254 256 0.6 1.1\n512 512\ncrop\n512 512\n").camera.model, CameraModelKind::kEucm);
  EXPECT_NE(error("EUCM 190 190 254 256 1.6 1.1\n512 512\ncrop\n512 512\n").find("camera.txt:1: the EUCM's alpha"),
            std::string::npos);
}

TEST_F(CameraFile, MayHaveCommentsBehindItsValues) {
  const Calibration r =
      read("# my camera\nPinhole 525 526 319.5 239.5 0  # fx fy cx cy\n640 480 # size\ncrop #\n640 480\n");
  EXPECT_EQ(r.camera.fy, 526);
  EXPECT_EQ(r.rectification.mode, RectificationMode::kCrop);
}

TEST_F(CameraFile, ExplicitIntrinsicsAreRelativeToTheOutputSize) {
  const Calibration a = read("FOV 500 501 319.5 239.5 0.9\n640 480\n0.4 0.5 0.5 0.5 0\n320 240\n");
  ASSERT_EQ(a.rectification.mode, RectificationMode::kExplicit);
  EXPECT_DOUBLE_EQ(a.rectification.explicit_intrinsics.fx, 128);
  EXPECT_DOUBLE_EQ(a.rectification.explicit_intrinsics.cy, 119.5);
  EXPECT_EQ(a.rectification.explicit_intrinsics.width, 320);
  const Calibration b = read("FOV 500 501 319.5 239.5 0.9\n640 480\n128 120 159.5 119.5 0\n320 240\n");
  EXPECT_DOUBLE_EQ(b.rectification.explicit_intrinsics.fx, 128);
  EXPECT_DOUBLE_EQ(b.rectification.explicit_intrinsics.cx, 159.5);
}

TEST_F(CameraFile, MissingFileIsNamed) {
  EXPECT_NE(error_of([&] { read_camera_calibration(folder_ / "nope.txt"); }).find("nope.txt"), std::string::npos);
}

TEST_F(CameraFile, ShortFileSaysWhatTheLinesAre) {
  for (const char* text : {"", "525 525 319.5 239.5 0\n", "525 525 319.5 239.5 0\n640 480\ncrop\n"}) {
    EXPECT_NE(error(text).find("four are expected"), std::string::npos) << text;
  }
}

struct BadLine {
  const char* text;
  const char* complaint;
};

TEST_F(CameraFile, BadLinesAreNamedWithWhatIsExpected) {
  const BadLine cases[] = {
      {"Fisheye 1 2 3 4 5\n640 480\ncrop\n640 480\n", "camera.txt:1: unknown camera model 'Fisheye'"},
      {"525 525 319.5 239.5\n640 480\ncrop\n640 480\n", "camera.txt:1: 4 numbers without the name of a model"},
      {"1 2 3 4 5 6 7 8\n640 480\ncrop\n640 480\n", "camera.txt:1: 8 numbers without the name of a model"},
      {"RadTan 525 525 319.5 239.5 0.1\n640 480\ncrop\n640 480\n", "expected `RadTan fx fy cx cy k1 k2 p1 p2`"},
      {"525 nan 319.5 239.5 0\n640 480\ncrop\n640 480\n", "camera.txt:1: 'nan' is not finite"},
      {"525 0 319.5 239.5 0\n640 480\ncrop\n640 480\n", "camera.txt:1: a focal length is not positive"},
      {"FOV 525 525 319.5 239.5 4\n640 480\ncrop\n640 480\n", "camera.txt:1: omega"},
      {"Pinhole 525 525 319.5 239.5 0.1\n640 480\ncrop\n640 480\n", "camera.txt:1: a pinhole camera has no distortion"},
      {"525 525 319.5 239.5 0\n640\ncrop\n640 480\n", "camera.txt:2: '640' is no image size"},
      {"525 525 319.5 239.5 0\n640 -480\ncrop\n640 480\n", "camera.txt:2: '640 -480' is no image size"},
      {"525 525 319.5 239.5 0\n640 480\ncrpo\n640 480\n", "camera.txt:3: unknown rectification 'crpo'"},
      {"525 525 319.5 239.5 0\n640 480\n0.4 0.5 0.5\n640 480\n", "camera.txt:3: has 3 numbers"},
      {"525 525 319.5 239.5 0\n640 480\n0.4 0.5 0.5 0.5 0.9\n640 480\n", "camera.txt:3: rectified images have no"},
      {"525 525 319.5 239.5 0.9\n640 480\nnone\n640 480\n", "camera.txt:3: 'none' is only possible without distortion"},
      {"525 525 319.5 239.5 0\n640 480\nnone\n320 240\n", "camera.txt:4: with 'none' the images keep their size"},
      {"525 525 319.5 239.5 0\n640 480\ncrop\n0 0\n", "camera.txt:4: '0 0' is no image size"},
      {"525 525 319.5 239.5 0\n640 480\ncrop\n640 480\n1\n", "camera.txt:5: '1' is unknown here"},
      {"525 525 319.5 239.5 0\n640 480\ncrop\n640 480\nrolling_shutter 900\n", "camera.txt:5: a readout of 900 ms"},
      {"525 525 319.5 239.5 0\n640 480\ncrop\n640 480\nrolling_shutter x\n", "camera.txt:5"},
      {"525 525 319.5 239.5 0\n640 480\ncrop\n640 480\nrolling_shutter 9\n1\n", "camera.txt:6: is one line too many"},
  };
  for (const BadLine& bad : cases) {
    const std::string message = error(bad.text);
    EXPECT_NE(message.find(bad.complaint), std::string::npos) << bad.text << "-> " << message;
  }
}

class ResponseFile : public CameraFile {
 protected:
  std::array<float, 256> response(const std::function<double(int)>& value, int count = 256) const {
    std::string text;
    for (int i = 0; i < count; ++i) text += std::to_string(value(i)) + (i % 16 == 15 ? "\n" : " ");
    write_text(folder_ / "pcalib.txt", text);
    return read_inverse_response(folder_ / "pcalib.txt");
  }
};

TEST_F(ResponseFile, IsScaledTo255) {
  const std::array<float, 256> table = response([](int i) { return 3 + 0.01 * i * i; });
  EXPECT_EQ(table.front(), 0.0F);
  EXPECT_EQ(table.back(), 255.0F);
  EXPECT_NEAR(table[128], 255.0 * 128 * 128 / (255.0 * 255.0), 1e-3);
}

TEST_F(ResponseFile, FlatPartsBecomeStrictlyIncreasing) {
  const std::array<float, 256> table = response([](int i) { return std::min(i, 250); });
  for (std::size_t i = 1; i < table.size(); ++i) EXPECT_GT(table[i], table[i - 1]) << i;
  EXPECT_NEAR(table[255], 255.0, 1e-3);
}

TEST_F(ResponseFile, BadTablesAreErrors) {
  EXPECT_NE(error_of([&] { response([](int i) { return i; }, 255); }).find("has 255 values"), std::string::npos);
  EXPECT_NE(error_of([&] { response([](int i) { return i == 20 ? 0 : i; }); }).find("pcalib.txt:2: value 21"),
            std::string::npos);
  EXPECT_NE(error_of([&] { response([](int) { return 7; }); }).find("all values are the same"), std::string::npos);
  EXPECT_NE(error_of([&] { response([](int i) { return i < 9 ? i : NAN; }); }).find("not finite"), std::string::npos);
}

TEST_F(CameraFile, WhatIsWrittenIsReadBack) {
  for (const std::string text : {"Pinhole 500.1 501.2 320.3 240.4 0\n640 480\nnone\n640 480\n",
                                 "RadTan 500.1 501.2 320.3 240.4 -0.2 0.07 0.001 -0.002\n640 480\ncrop\n320 240\n",
                                 "FOV 500.1 501.2 320.3 240.4 0.9\n640 480\nfull\n320 240\n",
                                 "FOV 500.1 501.2 320.3 240.4 0.9\n640 480\nfull\n320 240\nrolling_shutter 29.5\n",
                                 "KannalaBrandt 500.1 501.2 320.3 240.4 0.02 -0.01 0.003 -0.001\n640 480\n"
                                 "250 251 160.5 120.5 0\n320 240\n"}) {
    const Calibration before = read(text);
    const Calibration after = read(camera_file_text(before));
    EXPECT_EQ(describe(after.camera, after.rectification), describe(before.camera, before.rectification));
    EXPECT_EQ(after.camera.fx, before.camera.fx);
    EXPECT_EQ(after.camera.cy, before.camera.cy);
    EXPECT_EQ(after.camera.distortion, before.camera.distortion);
    EXPECT_EQ(after.camera.readout_ms, before.camera.readout_ms);
    EXPECT_EQ(after.rectification.explicit_intrinsics.cx, before.rectification.explicit_intrinsics.cx);
    EXPECT_EQ(after.rectification.height, before.rectification.height);
  }
}

TEST_F(CameraFile, AFifthLineTellsTheReadoutOfARollingShutter) {
  EXPECT_EQ(read("525 525 319.5 239.5 0\n640 480\ncrop\n640 480\nrolling_shutter 29.5\n").camera.readout_ms, 29.5);
  EXPECT_EQ(read("525 525 319.5 239.5 0\n640 480\ncrop\n640 480\n").camera.readout_ms, 0);
}

TEST_F(CameraFile, PhotometricFilesAreUsedIfTheyAreThere) {
  Calibration calibration;
  read_photometric_calibration(folder_.path(), calibration);
  EXPECT_FALSE(calibration.photometric.inverse_response.has_value());
  EXPECT_TRUE(calibration.photometric.vignette.empty());

  std::string table;
  for (int i = 0; i < 256; ++i) table += std::to_string(i) + " ";
  write_text(folder_ / "pcalib.txt", table);
  const Image<float> vignette(8, 6, 200.0F);
  write_grey16_png(folder_ / "vignette.png", vignette.view());
  read_photometric_calibration(folder_.path(), calibration);
  EXPECT_TRUE(calibration.photometric.inverse_response.has_value());
  EXPECT_EQ(calibration.photometric.vignette.width(), 8);
}

TEST_F(CameraFile, KittiMatricesAreReadByName) {
  write_text(folder_ / "calib.txt",
             "P0: 7.1e+02 0 601 0 0 707 183 0 0 0 1 0\nP1: 710 0 601 -386 0 707 183 0 0 0 1 0\nTr: 1 2\n");
  const auto matrices = read_kitti_calibration(folder_ / "calib.txt");
  ASSERT_EQ(matrices.size(), 2U);
  EXPECT_EQ(matrices.at("P0")(0, 0), 710);
  EXPECT_EQ(matrices.at("P1")(0, 3), -386);
  write_text(folder_ / "calib.txt", "P0: 710 0 601\n");
  EXPECT_NE(error_of([&] { read_kitti_calibration(folder_ / "calib.txt"); }).find("calib.txt:1: has 3 numbers"),
            std::string::npos);
  write_text(folder_ / "calib.txt", "nothing\n");
  EXPECT_NE(error_of([&] { read_kitti_calibration(folder_ / "calib.txt"); }).find("no projection"), std::string::npos);
}

TEST_F(CameraFile, MorePixelsThanCanBeHandledAreErrors) {
  EXPECT_NE(error("Pinhole 500 500 300 200 0\n32768 32768\nnone\n32768 32768\n").find("camera.txt:2: "),
            std::string::npos);
  EXPECT_NE(error("Pinhole 500 500 300 200 0\n640 480\ncrop\n32768 32768\n").find("camera.txt:4: "), std::string::npos);
}

TEST_F(CameraFile, AKittiCameraCanBeInverted) {
  write_text(folder_ / "calib.txt", "P0: 710 0 601 5 0 707 183 0 0 0 0 0\n");
  EXPECT_NE(error_of([&] { read_kitti_calibration(folder_ / "calib.txt"); }).find("calib.txt:1: the first three"),
            std::string::npos);
}

}  // namespace
}  // namespace ldso
