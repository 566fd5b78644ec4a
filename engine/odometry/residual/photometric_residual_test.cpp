#include "odometry/residual/photometric_residual.h"

#include <gtest/gtest.h>

#include <random>

#include "odometry/test_synthetic_scene.h"

namespace ldso {
namespace {

using test::random_tangent;
using test::uniform;

/// Projection of a host pixel in double: the definition that the Jacobians are measured against.
Eigen::Vector2d project(const SE3d& T_target_host, const Eigen::Vector4d& camera, double u, double v, double idepth) {
  const Eigen::Vector3d ray((u - camera[2]) / camera[0], (v - camera[3]) / camera[1], 1);
  const Eigen::Vector3d p = T_target_host.rotation() * ray + T_target_host.translation() * idepth;
  return {camera[0] * p.x() / p.z() + camera[2], camera[1] * p.y() / p.z() + camera[3]};
}

template <class F>
Eigen::Vector2d difference(const F& f) {
  constexpr double kStep = 1e-6;
  return (f(kStep) - f(-kStep)) / (2 * kStep);
}

void expect_column(const Eigen::Vector2f& actual, const Eigen::Vector2d& numeric, const char* name) {
  EXPECT_LT((actual.cast<double>() - numeric).norm(), 1e-4 * (numeric.norm() + 1))
      << name << ": " << actual.transpose() << " instead of " << numeric.transpose();
}

class PhotometricResidual : public testing::Test {
 protected:
  PhotometricResidual() {
    auto frame = std::make_shared<PreparedFrame>();
    frame->pyramid.levels.emplace_back(320, 240);
    frame->exposure_ms = 4;
    host_.frame = frame;
    auto other = std::make_shared<PreparedFrame>(*frame);
    other->exposure_ms = 6;
    target_.frame = other;
    target_.index = 1;
    randomize();
  }

  void randomize() {
    for (Keyframe* keyframe : {&host_, &target_}) {
      keyframe->state.T_c_w_lin = SE3d::exp(random_tangent(random_, 0.6, 0.4));
      keyframe->state.brightness_lin = {uniform(random_, -0.3, 0.3), uniform(random_, -9, 9)};
      keyframe->state.delta.head<6>() = random_tangent(random_, 0.05, 0.03);
      keyframe->state.delta.tail<2>() << uniform(random_, -0.1, 0.1), uniform(random_, -3, 3);
    }
    camera_lin_ << 220, 230, 158, 121;
    camera_ = camera_lin_ + Eigen::Vector4d(1, -1.5, 0.7, -0.4);
  }

  FramePair pair() const { return make_frame_pair(host_, target_, camera_, camera_lin_); }

  Keyframe host_, target_;
  Eigen::Vector4d camera_, camera_lin_;
  std::mt19937 random_{17};
};

TEST_F(PhotometricResidual, ProjectionJacobianMatchesDifferencesAtTheLinearizationPoint) {
  int checked = 0;
  for (int round = 0; round < 60; ++round) {
    randomize();
    const FramePair p = pair();
    const SE3d T = target_.state.T_c_w_lin * host_.state.T_c_w_lin.inverse();
    const double u = uniform(random_, 0, 320), v = uniform(random_, 0, 240), idepth = uniform(random_, 0.05, 0.8);
    const auto uf = static_cast<float>(u), vf = static_cast<float>(v), idepth_f = static_cast<float>(idepth);
    ProjectionJacobian J;
    const Eigen::Vector3d ray((uf - camera_lin_[2]) / camera_lin_[0], (vf - camera_lin_[3]) / camera_lin_[1], 1);
    const double z = (T.rotation() * ray + T.translation() * idepth).z();
    if (z < 0.3) continue;
    ASSERT_TRUE(projection_jacobian(p, uf, vf, idepth_f, J));
    for (int i = 0; i < 6; ++i) {
      expect_column(J.pose.col(i), difference([&](double step) {
                      SE3d::Tangent x = SE3d::Tangent::Zero();
                      x[i] = step;
                      return project(SE3d::exp(x) * T, camera_lin_, uf, vf, idepth_f);
                    }),
                    "pose");
    }
    for (int i = 0; i < 4; ++i) {
      expect_column(J.camera.col(i), difference([&](double step) {
                      Eigen::Vector4d camera = camera_lin_;
                      camera[i] += step;
                      return project(T, camera, uf, vf, idepth_f);
                    }),
                    "camera");
    }
    expect_column(J.idepth, difference([&](double step) { return project(T, camera_lin_, uf, vf, idepth_f + step); }),
                  "idepth");
    ++checked;
  }
  EXPECT_GT(checked, 30);
}

TEST_F(PhotometricResidual, PointsBehindTheTargetHaveNoJacobian) {
  host_.state = {};
  target_.state = {};
  target_.state.T_c_w_lin.translation() = Eigen::Vector3d(0.1, 0, -3);
  ProjectionJacobian J;
  EXPECT_FALSE(projection_jacobian(pair(), 160, 120, 0.5f, J));  // Depth 2, three behind.
  EXPECT_TRUE(projection_jacobian(pair(), 160, 120, 0.25f, J));  // Depth 4.
}

TEST_F(PhotometricResidual, TheWarpProjectsAtTheEstimate) {
  for (int round = 0; round < 20; ++round) {
    randomize();
    const PatternWarp warp = pair().warp;
    const SE3d T = target_.state.T_c_w() * host_.state.T_c_w().inverse();
    const double u = uniform(random_, 0, 320), v = uniform(random_, 0, 240), idepth = uniform(random_, 0.05, 0.4);
    Eigen::Vector3d p;
    for (int r = 0; r < 3; ++r) {
      p[r] = warp.KRKi[3 * r] * u + warp.KRKi[3 * r + 1] * v + warp.KRKi[3 * r + 2] + warp.Kt[r] * idepth;
    }
    if (p.z() < 0.3) continue;
    EXPECT_LT((p.hnormalized() - project(T, camera_, u, v, idepth)).norm(), 2e-3);
    const BrightnessTransfer transfer = brightness_transfer(4, host_.state.brightness(), 6, target_.state.brightness());
    const BrightnessTransfer lin = brightness_transfer(4, host_.state.brightness_lin, 6, target_.state.brightness_lin);
    EXPECT_NEAR(warp.factor, transfer.factor, 1e-5);
    EXPECT_NEAR(warp.offset, transfer.offset, 1e-4);
    EXPECT_NEAR(warp.factor_lin, lin.factor, 1e-5);
    EXPECT_NEAR(warp.host_b_lin, host_.state.brightness_lin.b, 1e-5);
    EXPECT_EQ(warp.texels, target_.image().data());
  }
}

/// A point seen in row v of a host that moves while it is read, found again in the row of the target that shows it.
TEST_F(PhotometricResidual, TheRollingWarpFindsTheRowsThatShowAPoint) {
  constexpr int kHeight = 240;
  int checked = 0;
  for (int round = 0; round < 60; ++round) {
    randomize();
    host_.velocity = random_tangent(random_, 0.6, 0.9);
    target_.velocity = random_tangent(random_, 0.6, 0.9);
    constexpr double kReadout = 0.03;
    const PatternWarp warp = make_frame_pair(host_, target_, camera_, camera_lin_, kReadout).warp;
    const double u = uniform(random_, 0, 320), v = uniform(random_, 0, 240), idepth = uniform(random_, 0.1, 0.5);
    const auto at_row = [&](const Keyframe& keyframe, double row) {
      return SE3d::exp(row_time(row, kHeight) * kReadout * keyframe.velocity) * keyframe.state.T_c_w();
    };
    const SE3d T_w_host = at_row(host_, v).inverse();
    double row = kHeight / 2.0;
    Eigen::Vector2d seen;
    for (int i = 0; i < 30; ++i) {
      seen = project(at_row(target_, row) * T_w_host, camera_, u, v, idepth);
      row = seen.y();
    }
    if (!(seen.array() > 0).all() || seen.x() > 320 || seen.y() > 240) continue;
    const PixelWarp w = warp_at(warp, static_cast<float>(u), static_cast<float>(v), static_cast<float>(idepth));
    Eigen::Vector3d p;
    for (int r = 0; r < 3; ++r) p[r] = w.KRKi[3 * r] * u + w.KRKi[3 * r + 1] * v + w.KRKi[3 * r + 2] + w.Kt[r] * idepth;
    if (p.z() < 0.3) continue;
    const double shift =
        (project(target_.state.T_c_w() * host_.state.T_c_w().inverse(), camera_, u, v, idepth) - seen).norm();
    EXPECT_LT((p.hnormalized() - seen).norm(), 0.02 + 0.03 * shift);
    checked += shift > 1 ? 1 : 0;
  }
  EXPECT_GT(checked, 8);
}

/// Left increments x_h of T_host_w and x_t of T_target_w move T_target_host by the tangent x_t + A x_h.
TEST_F(PhotometricResidual, HostAdjointMapsPoseIncrements) {
  const SE3d T_h = host_.state.T_c_w_lin, T_t = target_.state.T_c_w_lin;
  const auto A = pair().host_adjoint;
  for (int i = 0; i < 6; ++i) {
    const auto relative = [&](double step, bool host) {
      SE3d::Tangent x = SE3d::Tangent::Zero();
      x[i] = step;
      const SE3d moved = host ? T_t * (SE3d::exp(x) * T_h).inverse() : SE3d::exp(x) * T_t * T_h.inverse();
      return (moved * (T_t * T_h.inverse()).inverse()).log();
    };
    constexpr double kStep = 1e-6;
    const SE3d::Tangent by_host = (relative(kStep, true) - relative(-kStep, true)) / (2 * kStep);
    const SE3d::Tangent by_target = (relative(kStep, false) - relative(-kStep, false)) / (2 * kStep);
    EXPECT_LT((by_host - A.topLeftCorner<6, 6>().col(i)).norm(), 1e-7);
    EXPECT_LT((by_target - SE3d::Tangent::Unit(i)).norm(), 1e-7);
  }
  EXPECT_EQ((A.topRightCorner<6, 2>()).norm(), 0);
  EXPECT_EQ((A.bottomLeftCorner<2, 6>()).norm(), 0);
}

/// The derivative of the residual by the host's brightness is that by the relative brightness times A.
TEST_F(PhotometricResidual, HostAdjointMapsBrightness) {
  const double grey = 97;
  const Brightness h = host_.state.brightness_lin, t = target_.state.brightness_lin;
  const auto residual = [&](const Brightness& host, const Brightness& target) {
    const BrightnessTransfer transfer = brightness_transfer(4, host, 6, target);
    return -(transfer.factor * grey + transfer.offset);
  };
  const FramePair p = pair();
  // As the kernels define them.
  const Eigen::Vector2d J(-p.warp.factor_lin * (grey - p.warp.host_b_lin), -1);
  constexpr double kStep = 1e-5;
  const auto by = [&](auto moved) { return (moved(kStep) - moved(-kStep)) / (2 * kStep); };
  const Eigen::Vector2d by_target(by([&](double s) {
                                    return residual(h, {t.a + s, t.b});
                                  }),
                                  by([&](double s) {
                                    return residual(h, {t.a, t.b + s});
                                  }));
  const Eigen::Vector2d by_host(by([&](double s) {
                                  return residual({h.a + s, h.b}, t);
                                }),
                                by([&](double s) {
                                  return residual({h.a, h.b + s}, t);
                                }));
  EXPECT_LT((by_target - J).norm(), 1e-4 * J.norm());
  const Eigen::Vector2d mapped = p.host_adjoint.bottomRightCorner<2, 2>().transpose() * J;
  EXPECT_LT(std::abs(by_host[0] - mapped[0]), 1e-4 * std::abs(mapped[0]));
  EXPECT_LT(std::abs(by_host[1] - mapped[1]), 1e-4 * std::abs(mapped[1]));
}

}  // namespace
}  // namespace ldso
