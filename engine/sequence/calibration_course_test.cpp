#include "sequence/calibration_course.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>

#include "sequence/test_scene_source.h"

namespace ldso {
namespace {

/// The windows speak for a focal length that is `factor` times the given one.
CalibrationFindings findings(double deviations, double factor, double log_rmse) {
  CalibrationFindings result{{deviations, scene_calibration()}, {}};
  result.better.camera.fx *= factor;
  for (int frame = 40; frame < 300; frame += 5) result.fits.push_back({frame, log_rmse, 1});
  return result;
}

/// A course whose first pass was contradicted and whose second one has proven nothing: it has refused.
class RefusedCourse : public testing::Test {
 protected:
  void refuse(double deviations, double disagreement = 1) {
    CalibrationFindings first = findings(20, 1.04, 1);
    first.disagreement = disagreement;
    course.search().begins_anew(first);
    course.begin_anew();
    tried_fx = course.calibration().camera.fx;
    course.search().begins_anew(findings(deviations, 1.2, 1.2));
    course.begin_anew();
  }

  SceneSource source{30};
  Settings settings;
  std::string said;
  LogSink log = [this](LogLevel, const std::string& text) { said += text + "\n"; };
  std::atomic<bool> stop = true;  // Nothing is tried in earnest.
  CalibrationCourse course{source, settings, log, &stop};
  double tried_fx = 0;
};

TEST(CalibrationCourse, BeginsWithWhatWasGiven) {
  const SceneSource source(30);
  const Settings settings;
  const LogSink log;
  const CalibrationCourse course(source, settings, log, nullptr);
  EXPECT_TRUE(course.is_open());
  EXPECT_EQ(course.calibration().camera.fx, scene_calibration().camera.fx);
  SequenceRun run;
  course.note(run);
  course.note_found_camera(run);
  EXPECT_FALSE(run.is_corrected);
  EXPECT_FALSE(run.found_camera);
}

TEST_F(RefusedCourse, GoesBackToWhatWasGiven) {
  refuse(7);
  EXPECT_NE(tried_fx, scene_calibration().camera.fx);
  EXPECT_EQ(course.calibration().camera.fx, scene_calibration().camera.fx);
  EXPECT_FALSE(course.is_open());
  SequenceRun run;
  course.note(run);
  EXPECT_FALSE(run.is_corrected);
  EXPECT_NE(run.refused_correction.find("residuals have become larger"), std::string::npos) << run.refused_correction;
  EXPECT_EQ(said.find("another camera"), std::string::npos) << "too little speaks against it: " << said;
}

TEST_F(RefusedCourse, WhatIsContradictedForCertainMayBeAnotherCameras) {
  refuse(40);
  EXPECT_NE(said.find("may be another camera's"), std::string::npos) << said;
  EXPECT_EQ(course.calibration().camera.fx, scene_calibration().camera.fx) << "the search was stopped";
  SequenceRun run;
  course.note(run);
  EXPECT_FALSE(run.is_corrected);
  EXPECT_NE(run.refused_correction, "");
}

TEST_F(RefusedCourse, SoMayWhatWindowsContradictEachOtherAbout) {
  refuse(7, 4);
  EXPECT_NE(said.find("may be another camera's"), std::string::npos) << said;
}

}  // namespace
}  // namespace ldso
