#include "io/calibration/calibration_doubts.h"

#include <gtest/gtest.h>

#include "io/datasets/test_sequences.h"
#include "ldso/io/calibration_file.h"
#include "ldso/io/dataset.h"

namespace ldso {
namespace {

struct Doubted {
  const char* first_line;
  const char* said;  ///< Empty: nothing.
};

class CalibrationDoubts : public testing::Test {
 protected:
  Calibration read(const std::string& first_line) const {
    write_text(folder_ / "camera.txt", first_line + "\n640 480\ncrop\n640 480\n");
    return read_camera_calibration(folder_ / "camera.txt");
  }
  void expect_error(const Doubted& doubted) const {
    const std::string message = error_of([&] { read(doubted.first_line); });
    EXPECT_NE(message.find(doubted.said), std::string::npos) << doubted.first_line << " -> " << message;
    EXPECT_NE(message.find("camera.txt:1: "), std::string::npos) << message;
  }
  void expect_warning(const Doubted& doubted) const {
    const std::vector<std::string> warnings = read(doubted.first_line).warnings;
    ASSERT_EQ(warnings.size(), 1U) << doubted.first_line;
    EXPECT_NE(warnings[0].find(doubted.said), std::string::npos) << doubted.first_line << " -> " << warnings[0];
    EXPECT_NE(warnings[0].find("camera.txt:1: "), std::string::npos) << warnings[0];
  }

  TemporaryFolder folder_;
};

TEST_F(CalibrationDoubts, NoneAboutRealCameras) {
  for (const char* line :
       {"Pinhole 525 525 319.5 239.5 0", "0.349153 0.436593 0.493140 0.499021 0.933271",
        "RadTan 517.3 516.5 318.6 255.3 -0.28 0.07 0.0002 1.7e-05", "FOV 250 251 319.5 239.5 0.9",
        "KannalaBrandt 190.9 190.9 319 241 0.003 0.0007 -0.002 0.0002", "Pinhole 718 718 420 185 0"}) {
    EXPECT_TRUE(read(line).warnings.empty()) << line << " -> " << read(line).warnings.front();
  }
}

TEST_F(CalibrationDoubts, WhatNoCameraCanBeIsAnError) {
  const Doubted cases[] = {
      {"Pinhole 525 319.5 525 239.5 0", "look like `fx cx fy cy`"},
      {"Pinhole 3000 3000 2015.5 1511.5 0", "the principal point is outside of the image"},
      {"Pinhole 525 525 319.5 -20 0", "the principal point is outside of the image"},
      {"Pinhole 4.2 4.2 319.5 239.5 0", "relative to the image size or in millimetres"},
      {"Pinhole 0.8 1.1 319.5 239.5 0", "relative to the image size or in millimetres"},
      {"KannalaBrandt 2.8 2.8 319.5 239.5 0 0 0 0", "relative to the image size or in millimetres"},
      {"Pinhole 525 525 0.5 0.5 0", "the centre is relative to the image size, but the focal lengths are not"},
      {"Pinhole 0.8 1.1 0.5 239.5 0", "one coordinate of the centre is relative"},
      {"Pinhole 20 20 319.5 239.5 0", "the field of view would be 173 degrees"},
      {"RadTan 300 300 319.5 239.5 -3 0 0 0", "there is no ray for pixels well inside of the image"},
      {"KannalaBrandt 30 30 319.5 239.5 0 0 0 0", "there is no ray for pixels well inside of the image"},
  };
  for (const Doubted& doubted : cases) expect_error(doubted);
}

TEST_F(CalibrationDoubts, WhatFewCamerasAreIsAWarning) {
  const Doubted cases[] = {
      {"Pinhole 525 525 500 239.5 0", "28 % of the image size away from its middle"},
      {"Pinhole 525 400 319.5 239.5 0", "fx and fy differ by more than 20 %"},
      {"Pinhole 20000 20000 319.5 239.5 0", "the field of view is only 1.83 degrees"},
      {"RadTan 300 300 319.5 239.5 -0.3 0 0 0", "the distortion folds over inside of the image"},
  };
  for (const Doubted& doubted : cases) expect_warning(doubted);
}

TEST_F(CalibrationDoubts, AreWarningsOfTheSequence) {
  make_tum_mono(folder_.path(), 2);
  write_text(folder_ / "camera.txt", "Pinhole 40 60 15.5 11.5 0\n32 24\nnone\n32 24\n");
  const auto dataset = open_dataset(folder_.path());
  ASSERT_EQ(dataset->warnings().size(), 1U);
  EXPECT_NE(dataset->warnings()[0].find("fx and fy differ"), std::string::npos);
}

}  // namespace
}  // namespace ldso
