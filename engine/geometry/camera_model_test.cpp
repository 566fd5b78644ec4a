#include "geometry/camera_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "ldso/error.h"

namespace ldso {
namespace {

bool has_pixel(const CameraModel& camera, const Eigen::Vector3d& point) { return camera.project(point).allFinite(); }

struct Case {
  std::string name;
  CameraCalibration calibration;
  double least_part_with_rays = 1;  ///< Of the image: some lenses see behind or fold before its corners.
};

// The name is GoogleTest's. NOLINTNEXTLINE(readability-identifier-naming)
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

CameraCalibration calibration(CameraModelKind model, int width, int height, const std::array<double, 4>& intrinsics,
                              const std::array<double, 4>& distortion) {
  return {model, width, height, intrinsics[0], intrinsics[1], intrinsics[2], intrinsics[3], distortion};
}

/// RadTan with OpenCV's k3 and denominator.
CameraCalibration with_more(CameraCalibration camera, const std::array<double, 4>& more) {
  camera.more_distortion = more;
  return camera;
}

/// Calibrations of public data sets, and the corners of each model.
std::vector<Case> cases() {
  const std::array<double, 4> tum_mono{0.349153 * 1280, 0.436593 * 1024, 0.493140 * 1280 - 0.5, 0.499021 * 1024 - 0.5};
  return {
      {"pinhole", calibration(CameraModelKind::kPinhole, 1241, 376, {718.856, 718.856, 607.1928, 185.2157}, {})},
      {"fov", calibration(CameraModelKind::kFov, 1280, 1024, tum_mono, {0.933271, 0, 0, 0}), 0.95},
      {"fov_weak", calibration(CameraModelKind::kFov, 640, 480, {400, 410, 320, 240}, {0.01, 0, 0, 0})},
      {"fov_tiny", calibration(CameraModelKind::kFov, 640, 480, {400, 410, 320, 240}, {3e-5, 0, 0, 0})},
      {"fov_zero", calibration(CameraModelKind::kFov, 640, 480, {400, 410, 320, 240}, {})},
      {"radtan", calibration(CameraModelKind::kRadTan, 752, 480, {458.654, 457.296, 367.215, 248.375},
                             {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05})},
      {"radtan_strong",
       calibration(CameraModelKind::kRadTan, 640, 480, {517.3, 516.5, 318.6, 255.3},
                   {0.2624, -0.9531, -0.0054, 0.0026}),
       0.85},
      {"radtan_zero", calibration(CameraModelKind::kRadTan, 640, 480, {500, 500, 320, 240}, {})},
      {"fisheye",
       calibration(CameraModelKind::kKannalaBrandt, 512, 512, {190.97847715, 190.97330716, 254.93170606, 256.8974428},
                   {0.0034823894, 0.00071500348, -0.0020532361, 0.00020293673}),
       0.7},
      {"radtan_k3",  // of the camera of TUM RGB-D's freiburg1
       with_more(calibration(CameraModelKind::kRadTan, 640, 480, {517.306408, 516.469215, 318.643040, 255.313989},
                             {0.262383, -0.953104, -0.005358, 0.002628}),
                 {1.163314, 0, 0, 0})},
      {"radtan_ratio",  // of an Azure Kinect's colour camera
       with_more(calibration(CameraModelKind::kRadTan, 1280, 720, {605.4, 605.2, 639.1, 366.9},
                             {0.4466, -2.5836, 0.00088, -0.00024}),
                 {1.5156, 0.3263, -2.4094, 1.4435})},
      {"double_sphere",  // of TUM-VI
       calibration(CameraModelKind::kDoubleSphere, 512, 512, {158.28600, 158.28600, 254.5, 255.2},
                   {-0.172154, 0.593344, 0, 0}),
       0.7},
      {"double_sphere_narrow",
       calibration(CameraModelKind::kDoubleSphere, 640, 480, {400, 401, 320, 240}, {0.2, 0.3, 0, 0})},
      {"eucm", calibration(CameraModelKind::kEucm, 512, 512, {190.2, 190.1, 254.9, 256.8}, {0.63, 1.04, 0, 0}), 0.7},
      {"eucm_narrow", calibration(CameraModelKind::kEucm, 640, 480, {400, 401, 320, 240}, {0.4, 0.9, 0, 0})},
      {"eucm_zero", calibration(CameraModelKind::kEucm, 640, 480, {400, 401, 320, 240}, {0, 1, 0, 0})},
  };
}

bool sees_behind(CameraModelKind model) {
  return model == CameraModelKind::kKannalaBrandt || model == CameraModelKind::kDoubleSphere ||
         model == CameraModelKind::kEucm;
}

class CameraModelTest : public testing::TestWithParam<Case> {
 protected:
  const CameraCalibration& cal() const { return GetParam().calibration; }
  const std::unique_ptr<CameraModel> camera_ = make_camera_model(GetParam().calibration);

  /// Pixels all over the image, its borders, and the principal point.
  std::vector<Eigen::Vector2d> pixels() const {
    std::vector<Eigen::Vector2d> result{{cal().cx, cal().cy}, {cal().cx + 1e-7, cal().cy}};
    for (int i = 0; i <= 20; ++i) {
      for (int j = 0; j <= 20; ++j) result.emplace_back((cal().width - 1) * i / 20.0, (cal().height - 1) * j / 20.0);
    }
    return result;
  }

  /// Points at several depths that are seen in those pixels.
  std::vector<Eigen::Vector3d> points() const {
    std::vector<Eigen::Vector3d> result;
    double depth = 0.3;
    for (const Eigen::Vector2d& pixel : pixels()) {
      const auto ray = camera_->unproject(pixel);
      // Rays next to 90 degrees are left to the round trip: their z = 1 makes differences meaningless.
      if (ray && ray->norm() < 20) result.push_back(depth * *ray);
      depth = depth > 10 ? 0.3 : depth * 1.3;
    }
    return result;
  }
};

TEST_P(CameraModelTest, PixelsGoThereAndBack) {
  int rays = 0;
  for (const Eigen::Vector2d& pixel : pixels()) {
    const auto ray = camera_->unproject(pixel);
    if (!ray) continue;
    ++rays;
    EXPECT_EQ(ray->z(), 1);
    EXPECT_TRUE(has_pixel(*camera_, *ray));
    EXPECT_LT((camera_->project(*ray) - pixel).norm(), 1e-10) << pixel.transpose();
    EXPECT_LT((camera_->project(7.5 * *ray) - pixel).norm(), 1e-10) << pixel.transpose();
  }
  EXPECT_GE(rays, GetParam().least_part_with_rays * pixels().size());
}

TEST_P(CameraModelTest, PointsGoThereAndBack) {
  for (const Eigen::Vector3d& p : points()) {
    const auto ray = camera_->unproject(camera_->project(p));
    ASSERT_TRUE(ray.has_value());
    EXPECT_LT((*ray - p / p.z()).norm(), 1e-11 * ray->squaredNorm());
  }
}

TEST_P(CameraModelTest, PointJacobianMatchesDifferences) {
  for (const Eigen::Vector3d& p : points()) {
    CameraModel::Matrix23 J;
    const Eigen::Vector2d pixel = camera_->project(p, &J);
    EXPECT_EQ(pixel, camera_->project(p));
    CameraModel::Matrix23 numeric;
    const double step = 1e-5 * p.z();
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d d = step * Eigen::Vector3d::Unit(i);
      numeric.col(i) = (camera_->project(p + d) - camera_->project(p - d)) / (2 * step);
    }
    EXPECT_LT((J - numeric).norm(), 1e-7 * J.norm()) << p.transpose() << "\n" << J << "\n" << numeric;
  }
}

TEST_P(CameraModelTest, ParameterJacobianMatchesDifferences) {
  const int count = camera_->parameter_count();
  for (int k = 0; k < count; ++k) {
    CameraCalibration plus = cal(), minus = cal();
    const auto parameter = [k](CameraCalibration& c) -> double& {
      const std::array<double*, 4> intrinsics{&c.fx, &c.fy, &c.cx, &c.cy};
      return k < 4 ? *intrinsics[k] : c.distortion[k - 4];
    };
    double step = k < 4 ? 1e-3 : 1e-6;
    const bool fov_parameter = cal().model == CameraModelKind::kFov && k == 4;
    if (fov_parameter) step = std::min(1e-4, 0.5 * cal().distortion[0]);  // it must not become negative
    if (step == 0) continue;                                              // omega = 0: FovDerivativeAtZero
    parameter(plus) += step;
    parameter(minus) -= step;
    const auto camera_plus = make_camera_model(plus);
    const auto camera_minus = make_camera_model(minus);
    for (const Eigen::Vector3d& p : points()) {
      Eigen::Matrix2Xd J;
      const Eigen::Vector2d pixel = camera_->project(p, nullptr, &J);
      ASSERT_EQ(J.cols(), count);
      const Eigen::Vector2d numeric = (camera_plus->project(p) - camera_minus->project(p)) / (2 * step);
      const double rounding = 1e-15 * pixel.norm() / step;
      EXPECT_LT((J.col(k) - numeric).norm(), 1e-6 * J.col(k).norm() + 8 * rounding + 1e-9) << k << " " << p.transpose();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, CameraModelTest, testing::ValuesIn(cases()),
                         [](const testing::TestParamInfo<Case>& test) { return test.param.name; });

TEST(FovCameraTest, FollowsTheFormulaOfTheBenchmark) {
  const double omega = 0.9;
  const auto camera = make_camera_model(calibration(CameraModelKind::kFov, 640, 480, {300, 310, 320, 240}, {omega}));
  const Eigen::Vector2d u(0.4, -0.7);
  const double ru = u.norm();
  const double rd = std::atan(2 * ru * std::tan(omega / 2)) / omega;
  const Eigen::Vector2d expected(300 * u.x() * rd / ru + 320, 310 * u.y() * rd / ru + 240);
  EXPECT_LT((camera->project({u.x(), u.y(), 1}) - expected).norm(), 1e-12);
}

TEST(FovCameraTest, OmegaZeroIsThePinhole) {
  const auto fov = make_camera_model(calibration(CameraModelKind::kFov, 640, 480, {300, 310, 320, 240}, {}));
  const auto pinhole = make_camera_model(calibration(CameraModelKind::kPinhole, 640, 480, {300, 310, 320, 240}, {}));
  const Eigen::Vector3d p(0.4, -0.7, 1.3);
  EXPECT_EQ(fov->project(p), pinhole->project(p));
  EXPECT_EQ(*fov->unproject({17, 401}), *pinhole->unproject({17, 401}));
}

TEST(FovCameraTest, SeriesAndClosedFormMeet) {
  const auto project = [](double omega, Eigen::Matrix2Xd& J) {
    const auto camera = make_camera_model(calibration(CameraModelKind::kFov, 640, 480, {300, 310, 320, 240}, {omega}));
    return camera->project({0.4, -0.7, 1}, nullptr, &J);
  };
  Eigen::Matrix2Xd J_below, J_above;
  const Eigen::Vector2d below = project(1e-4 * (1 - 1e-9), J_below);
  const Eigen::Vector2d above = project(1e-4 * (1 + 1e-9), J_above);
  EXPECT_LT((above - below).norm(), 1e-12 * below.norm());
  EXPECT_LT((J_above - J_below).norm(), 1e-9 * J_below.norm());
}

TEST(FovCameraTest, FovDerivativeAtZeroVanishes) {
  // The model is even in omega.
  const auto camera = make_camera_model(calibration(CameraModelKind::kFov, 640, 480, {300, 310, 320, 240}, {}));
  Eigen::Matrix2Xd J;
  camera->project({0.4, -0.7, 1}, nullptr, &J);
  EXPECT_TRUE(J.col(4).isZero(0));
}

TEST(FovCameraTest, PixelsBeyondTheHalfSpaceHaveNoRay) {
  const auto camera = make_camera_model(calibration(CameraModelKind::kFov, 640, 480, {100, 100, 320, 240}, {0.9}));
  const double edge = 100 * std::numbers::pi / 2 / 0.9;
  EXPECT_TRUE(camera->unproject({320 + 0.99 * edge, 240}).has_value());
  EXPECT_FALSE(camera->unproject({320 + 1.01 * edge, 240}).has_value());
}

TEST(RadTanCameraTest, FollowsTheFormula) {
  const double k1 = -0.3, k2 = 0.1, p1 = 0.01, p2 = -0.02, x = 0.3, y = -0.5, r2 = x * x + y * y;
  const auto camera =
      make_camera_model(calibration(CameraModelKind::kRadTan, 640, 480, {1, 1, 0, 0}, {k1, k2, p1, p2}));
  const double radial = 1 + k1 * r2 + k2 * r2 * r2;
  const Eigen::Vector2d expected(x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
                                 y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y);
  EXPECT_LT((camera->project({x, y, 1}) - expected).norm(), 1e-15);
}

TEST(RadTanCameraTest, FollowsOpenCvsFormulaWithEightCoefficients) {
  const double k1 = 0.4, k2 = -2.5, p1 = 0.01, p2 = -0.02, k3 = 1.5, k4 = 0.3, k5 = -2.4, k6 = 1.4;
  const double x = 0.2, y = -0.3, r2 = x * x + y * y, r4 = r2 * r2, r6 = r4 * r2;
  const auto camera = make_camera_model(
      with_more(calibration(CameraModelKind::kRadTan, 640, 480, {1, 1, 0, 0}, {k1, k2, p1, p2}), {k3, k4, k5, k6}));
  const double factor = (1 + k1 * r2 + k2 * r4 + k3 * r6) / (1 + k4 * r2 + k5 * r4 + k6 * r6);
  const Eigen::Vector2d expected(x * factor + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
                                 y * factor + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y);
  EXPECT_LT((camera->project({x, y, 1}) - expected).norm(), 1e-15);
}

TEST(DoubleSphereCameraTest, FollowsTheFormulaAndIsTheUnifiedModelWithoutItsSecondSphere) {
  const double xi = -0.2, alpha = 0.6;
  const Eigen::Vector3d p(0.7, -0.4, 0.9);
  const auto model = [](CameraModelKind kind, double a, double b) {
    return make_camera_model(calibration(kind, 640, 480, {1, 1, 0, 0}, {a, b, 0, 0}));
  };
  const double z2 = xi * p.norm() + p.z();
  const double d2 = std::hypot(p.x(), p.y(), z2);
  const Eigen::Vector2d expected = p.head<2>() / (alpha * d2 + (1 - alpha) * z2);
  EXPECT_LT((model(CameraModelKind::kDoubleSphere, xi, alpha)->project(p) - expected).norm(), 1e-15);
  EXPECT_LT((model(CameraModelKind::kDoubleSphere, 0, alpha)->project(p) -
             model(CameraModelKind::kEucm, alpha, 1)->project(p))
                .norm(),
            1e-15);
}

TEST(RadTanCameraTest, NothingBeyondTheTurningPoint) {
  // g(r) = r - 0.3 r^3 grows up to r = 1.054, where it is 0.7027.
  const auto camera = make_camera_model(calibration(CameraModelKind::kRadTan, 640, 480, {100, 100, 0, 0}, {-0.3}));
  EXPECT_TRUE(has_pixel(*camera, {1.05, 0, 1}));
  EXPECT_FALSE(has_pixel(*camera, {1.06, 0, 1}));
  // This point would land inside of the image, on the pixel of another one.
  CameraModel::Matrix23 J;
  Eigen::Matrix2Xd J_params;
  EXPECT_TRUE(camera->project({1.5, 0, 1}, &J, &J_params).array().isNaN().all());
  EXPECT_TRUE(J.array().isNaN().all());
  EXPECT_TRUE(J_params.array().isNaN().all());
  EXPECT_EQ(J_params.cols(), 8);
  EXPECT_NEAR(camera->unproject({70.2, 0}).value().x(), 1.02, 0.02);
  EXPECT_FALSE(camera->unproject({70.3, 0}).has_value());
  EXPECT_FALSE(camera->unproject({3000, -2000}).has_value());
}

TEST(RadTanCameraTest, EveryPixelOfAFoldingLensIsConsistent) {
  const auto camera = make_camera_model(
      calibration(CameraModelKind::kRadTan, 640, 480, {250, 250, 320, 240}, {-0.35, 0.02, 0.003, -0.002}));
  int with_ray = 0, without_ray = 0;
  for (int y = 0; y < 480; y += 5) {
    for (int x = 0; x < 640; x += 5) {
      const auto ray = camera->unproject(Eigen::Vector2d(x, y));
      ++(ray ? with_ray : without_ray);
      if (!ray) continue;
      EXPECT_LT((camera->project(*ray) - Eigen::Vector2d(x, y)).norm(), 1e-9) << x << " " << y;
    }
  }
  EXPECT_GT(with_ray, 500);     // the disc that the lens reaches
  EXPECT_GT(without_ray, 500);  // the corners
}

TEST(KannalaBrandtCameraTest, SeesBehindButHasNoRayThere) {
  const auto camera =
      make_camera_model(calibration(CameraModelKind::kKannalaBrandt, 640, 480, {100, 100, 320, 240}, {}));
  const Eigen::Vector3d behind(1, 0, -0.2);
  const Eigen::Vector2d pixel = camera->project(behind);
  EXPECT_NEAR(pixel.x(), 320 + 100 * std::atan2(1, -0.2), 1e-10);
  EXPECT_FALSE(camera->unproject(pixel).has_value());
  EXPECT_FALSE(has_pixel(*camera, {0, 0, -1}));
  EXPECT_FALSE(has_pixel(*camera, {0, 0, 0}));
}

TEST(KannalaBrandtCameraTest, PointJacobianBehindTheCamera) {
  const auto camera = make_camera_model(
      calibration(CameraModelKind::kKannalaBrandt, 512, 512, {190, 191, 254, 256}, {0.003, 0.0007, -0.002, 0.0002}));
  const Eigen::Vector3d p(1.2, -0.9, -0.2);
  CameraModel::Matrix23 J, numeric;
  camera->project(p, &J);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d d = 1e-6 * Eigen::Vector3d::Unit(i);
    numeric.col(i) = (camera->project(p + d) - camera->project(p - d)) / 2e-6;
  }
  EXPECT_LT((J - numeric).norm(), 1e-8 * J.norm());
}

TEST(CameraModelDomainTest, PointsBehindThePerspectiveModelsAreOutside) {
  for (const Case& c : cases()) {
    const auto camera = make_camera_model(c.calibration);
    EXPECT_FALSE(has_pixel(*camera, {0.1, 0.1, std::numeric_limits<double>::quiet_NaN()})) << c.name;
    EXPECT_FALSE(camera->unproject({std::numeric_limits<double>::infinity(), 0}).has_value()) << c.name;
    EXPECT_FALSE(has_pixel(*camera, {0, 0, -1})) << c.name;
    if (sees_behind(c.calibration.model)) continue;
    EXPECT_FALSE(has_pixel(*camera, {0.1, 0.1, 0})) << c.name;
    EXPECT_TRUE(camera->project({0.1, 0.1, -2}).array().isNaN().all()) << c.name;
  }
}

std::string error_of(const CameraCalibration& c) {
  try {
    make_camera_model(c);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(MakeCameraModelTest, BadCalibrationsAreErrorsThatSayWhy) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const CameraCalibration good = calibration(CameraModelKind::kFov, 640, 480, {300, 300, 320, 240}, {0.9});
  EXPECT_EQ(error_of(good), "no error");
  CameraCalibration bad = good;
  bad.width = 0;
  EXPECT_NE(error_of(bad).find("image size 0 x 480"), std::string::npos);
  bad = good;
  bad.fy = -300;
  EXPECT_NE(error_of(bad).find("focal length fy"), std::string::npos);
  bad = good;
  bad.fx = nan;
  EXPECT_NE(error_of(bad).find("fx is not a finite"), std::string::npos);
  bad = good;
  bad.cy = nan;
  EXPECT_NE(error_of(bad).find("cy is not a finite"), std::string::npos);
  bad = good;
  bad.distortion[0] = 3.2;
  EXPECT_NE(error_of(bad).find("omega"), std::string::npos);
  bad.distortion[0] = -0.1;
  EXPECT_NE(error_of(bad).find("omega"), std::string::npos);
  bad = good;
  bad.model = CameraModelKind::kRadTan;
  bad.distortion[3] = nan;
  EXPECT_NE(error_of(bad).find("distortion coefficient"), std::string::npos);
}

}  // namespace
}  // namespace ldso
