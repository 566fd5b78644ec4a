#include "scaling/metric_scale.h"

#include <gtest/gtest.h>

#include "ldso/error.h"

namespace ldso {
namespace {

/// Only its size counts: no image is read for distances.
class NoImages final : public Dataset {
 public:
  int size() const override { return 3; }
  RawFrame read(int) const override { throw Error("frame", "is not there", ""); }
  double timestamp(int index) const override { return index; }
  const Calibration& calibration() const override { return calibration_; }
  std::optional<Trajectory> ground_truth() const override { return std::nullopt; }
  std::string format_name() const override { return "none"; }
  const std::vector<std::string>& warnings() const override { return warnings_; }

 private:
  Calibration calibration_;
  std::vector<std::string> warnings_;
};

SlamResult straight_way() {
  SlamResult result;
  for (int i = 0; i < 3; ++i) {
    KeyframeUpdate keyframe;
    keyframe.frame_id = i;
    keyframe.T_world_camera = SE3d(SO3d(), {0.5 * i, 0, 0});
    result.keyframes.push_back(keyframe);
    FrameRecord frame;
    frame.frame_id = i;
    frame.state = i == 1 ? TrackingState::kLost : TrackingState::kTracked;
    frame.keyframe_id = i;
    result.frames.push_back(frame);
  }
  return result;
}

ScaleEstimate estimate(int a, int b, double metres) {
  const ScaleRequest request{KnownDistance{a, b, metres}, std::nullopt, std::nullopt};
  return estimate_scale(request, straight_way(), {}, NoImages());
}

TEST(MetricScale, ADistanceGivesTheUnit) {
  const ScaleEstimate scale = estimate(0, 2, 3);
  EXPECT_EQ(scale.problem, "");
  EXPECT_NEAR(scale.metres_per_unit, 3, 1e-12);
}

TEST(MetricScale, AFrameWithoutAPoseGivesNone) {
  const ScaleEstimate scale = estimate(0, 1, 3);
  EXPECT_NE(scale.problem.find("frame 1 has no pose"), std::string::npos);
  EXPECT_EQ(scale.metres_per_unit, 1);
}

TEST(MetricScale, ATagThatIsNowhereGivesNone) {
  const ScaleRequest request{std::nullopt, AprilTag{"36h11", 3, 0.16}, std::nullopt};
  Calibration calibration;
  calibration.camera = {CameraModelKind::kPinhole, 64, 48, 50, 50, 32, 24, {}};
  const ScaleEstimate scale = estimate_scale(request, straight_way(), calibration, NoImages());
  EXPECT_NE(scale.problem.find("found in 0 images"), std::string::npos);
}

TEST(MetricScale, ImpossibleRequestsAreRefusedBeforeTheRun) {
  const auto check = [](int a, int b, double metres) {
    check_request({KnownDistance{a, b, metres}, std::nullopt, std::nullopt}, 3);
  };
  EXPECT_NO_THROW(check(0, 2, 1));
  EXPECT_THROW(check(0, 3, 1), Error);
  EXPECT_THROW(check(-1, 2, 1), Error);
  EXPECT_THROW(check(2, 2, 1), Error);
  EXPECT_THROW(check(0, 2, 0), Error);
  EXPECT_THROW(check_request({std::nullopt, std::nullopt, KnownHeight{-1}}, 3), Error);
}

}  // namespace
}  // namespace ldso
