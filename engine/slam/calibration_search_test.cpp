#include "slam/calibration_search.h"

#include <gtest/gtest.h>

#include "slam/test_scene.h"

namespace ldso {
namespace {

Calibration with_focal(double factor) {
  Calibration calibration = scene_calibration();
  calibration.camera.fx *= factor;
  calibration.camera.fy *= factor;
  return calibration;
}

/// The frames speak for a focal length that is `factor` times the given one, and have residuals of `log_rmse`.
CalibrationFindings findings(double deviations, double factor, double log_rmse) {
  CalibrationFindings result{{deviations, with_focal(factor)}, {}};
  for (int frame = 40; frame < 300; frame += 5) result.fits.push_back({frame, log_rmse, 1});
  return result;
}

TEST(CalibrationSearch, WithoutContradictionTheGivenCalibrationIsKept) {
  CalibrationSearch search(scene_calibration(), {});
  EXPECT_TRUE(search.is_open());
  EXPECT_FALSE(search.begins_anew(findings(3, 1.05, 1)));
  EXPECT_FALSE(search.is_open());
  EXPECT_FALSE(search.is_corrected());
  EXPECT_EQ(search.refusal(), "");
}

TEST(CalibrationSearch, WindowsThatContradictEachOtherNeedNotAgreeOnWhatIsWrong) {
  CalibrationFindings dispute = findings(4, 1.05, 1);
  dispute.disagreement = 4;
  CalibrationSearch search(scene_calibration(), {});
  EXPECT_TRUE(search.begins_anew(dispute));
  EXPECT_TRUE(search.is_disputed());
  CalibrationSearch agreed(scene_calibration(), {});
  EXPECT_FALSE(agreed.begins_anew(findings(4, 1.05, 1)));
  EXPECT_FALSE(agreed.is_disputed());
}

TEST(CalibrationSearch, ABetterOneIsAcceptedOnceItStaysAndExplainsTheSameFramesBetter) {
  CalibrationSearch search(scene_calibration(), {});
  ASSERT_TRUE(search.begins_anew(findings(20, 1.04, 1)));
  ASSERT_TRUE(search.begins_anew(findings(8, 1.05, 0.95)));
  ASSERT_FALSE(search.begins_anew(findings(1, 1.0501, 0.94)));
  EXPECT_TRUE(search.is_corrected());
  EXPECT_NE(search.proof().find("residuals changed by -6.00"), std::string::npos) << search.proof();
  EXPECT_FALSE(search.is_open());
  EXPECT_EQ(search.calibration().camera.fx, with_focal(1.05).camera.fx);
}

TEST(CalibrationSearch, WhatDoesNotExplainTheFramesBetterIsRefused) {
  for (const double log_rmse : {1.0, 1.02, 0.999}) {
    CalibrationSearch search(scene_calibration(), {});
    ASSERT_TRUE(search.begins_anew(findings(11, 1.04, 1)));
    ASSERT_TRUE(search.begins_anew(findings(1, 1.04, log_rmse))) << "the run has to begin with what was given";
    EXPECT_FALSE(search.is_open());
    EXPECT_FALSE(search.is_corrected());
    EXPECT_EQ(search.calibration().camera.fx, scene_calibration().camera.fx);
    EXPECT_NE(search.refusal().find("proves nothing"), std::string::npos) << search.refusal();
  }
}

/// Whether a change is accepted that was asked for by so many deviations, and with which residuals are this.
bool is_accepted(double deviations, double log_rmse) {
  CalibrationSearch search(scene_calibration(), {});
  EXPECT_TRUE(search.begins_anew(findings(deviations, 1.04, 1)));
  search.begins_anew(findings(1, 1.04, log_rmse));
  return search.is_corrected();
}

TEST(CalibrationSearch, APlainContradictionNeedsLessProof) {
  EXPECT_FALSE(is_accepted(11, 0.9965));
  EXPECT_TRUE(is_accepted(13, 0.9965));
  EXPECT_FALSE(is_accepted(13, 1.0));
  EXPECT_TRUE(is_accepted(20, 1.0)) << "a window makes up for a wrong focal length";
  EXPECT_FALSE(is_accepted(40, 1.01)) << "it has become worse";
}

TEST(CalibrationSearch, ABetterOneThatIsStillContradictedIsNotTakenForRight) {
  SelfCalibrationSettings settings;
  settings.passes = 2;
  for (const double left : {20, 8}) {
    CalibrationSearch search(scene_calibration(), settings);
    ASSERT_TRUE(search.begins_anew(findings(30, 1.04, 1)));
    search.begins_anew(findings(left, 1.06, 0.9));
    EXPECT_EQ(search.is_corrected(), left < 12) << search.refusal();
  }
}

TEST(CalibrationSearch, AGuessIsLeftWithoutProof) {
  Calibration guess = scene_calibration();
  guess.source = CameraSource::kNone;
  for (const double log_rmse : {1.01, 1.2}) {
    CalibrationSearch search(guess, {});
    ASSERT_TRUE(search.begins_anew(findings(8, 1.04, 1)));
    search.begins_anew(findings(1, 1.04, log_rmse));
    EXPECT_EQ(search.is_corrected(), log_rmse < 1.05) << log_rmse;
  }
}

TEST(CalibrationSearch, PassesThatDoNotComeToRestAreRefusedAsAWhole) {
  CalibrationSearch search(scene_calibration(), {});
  ASSERT_TRUE(search.begins_anew(findings(20, 1.04, 1)));
  ASSERT_TRUE(search.begins_anew(findings(20, 1.07, 0.8)));
  ASSERT_TRUE(search.begins_anew(findings(20, 1.14, 0.6)));
  EXPECT_FALSE(search.is_open());
  EXPECT_EQ(search.calibration().camera.fx, scene_calibration().camera.fx);
  EXPECT_NE(search.refusal().find("come to rest"), std::string::npos) << search.refusal();
}

TEST(CalibrationSearch, AClearContradictionNeedsNotAllFrames) {
  const SelfCalibrationSettings settings;
  CalibrationSearch search(scene_calibration(), settings);
  EXPECT_FALSE(search.is_clear(findings(1.5 * settings.significance, 1.1, 1)));
  EXPECT_TRUE(search.is_clear(findings(3 * settings.significance, 1.1, 1)));
  CalibrationFindings few = findings(3 * settings.significance, 1.1, 1);
  few.fits.resize(10);
  EXPECT_FALSE(search.is_clear(few)) << "nothing could be compared with them";
  ASSERT_TRUE(search.begins_anew(findings(20, 1.1, 1)));
  EXPECT_TRUE(search.is_clear(findings(7, 1.12, 0.9)));
  EXPECT_FALSE(search.is_clear(findings(7, 1.12, 1.2))) << "residuals are larger: more frames have to say so";
}

TEST(CalibrationSearch, OffItKeepsWhatWasGiven) {
  SelfCalibrationSettings settings;
  settings.enabled = false;
  EXPECT_FALSE(CalibrationSearch(scene_calibration(), settings).is_open());
  settings.enabled = true;
  settings.passes = 1;
  EXPECT_FALSE(CalibrationSearch(scene_calibration(), settings).is_open());
}

}  // namespace
}  // namespace ldso
