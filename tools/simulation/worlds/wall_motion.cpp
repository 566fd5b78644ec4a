#include "simulation/worlds/wall_motion.h"

#include <cmath>
#include <map>
#include <numbers>

#include "ldso/error.h"

namespace ldso::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kSlowTime = 5;      ///< [s]
constexpr double kSlowShare = 0.05;  ///< Of the usual speed.
constexpr double kSpeedUp = 2;       ///< From the slow to the usual speed [s].

/// To and fro once in `period` seconds, fastest at time 0.
double swing(double t, double period) { return std::sin(2 * std::numbers::pi * t / period); }

/// On a sphere round the middle of the wall.
SE3d orbit(double t, double way) {
  const double azimuth = way * 20 * kDegree * swing(t, 16), elevation = 6 * kDegree * swing(t, 11);
  const Vector3d gaze(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                      std::cos(azimuth) * std::cos(elevation));
  return SE3d(look_along(gaze), Vector3d(0, 0, kWallDistance) - kWallDistance * gaze);
}

/// In all directions, as a hand would carry a camera.
SE3d carried(double t, double way) {
  const Vector3d position(way * 0.8 * swing(t, 13), 0.2 * swing(t, 7), 0.35 * swing(t, 17));
  return SE3d(SO3d::exp({0, way * 0.1 * swing(t, 9), 0}) * SO3d::exp({0.05 * swing(t, 5), 0, 0}), position);
}

/// The time by which a usual motion has come as far: the integral of the speed, which rises as smooth_step() does.
double slowed(double t) {
  const double x = std::clamp((t - kSlowTime) / kSpeedUp, 0.0, 1.0), after = std::max(0.0, t - kSlowTime - kSpeedUp);
  const double usual = kSpeedUp * (x * x * x - 0.5 * x * x * x * x) + after;
  return kSlowShare * t + (1 - kSlowShare) * usual;
}

class WallPath : public CameraPath {
 public:
  WallPath(WallMotion motion, double way, double duration) : motion_(motion), way_(way), duration_(duration) {}

  double duration() const override { return duration_; }

  SE3d pose(double t) const override {
    switch (motion_) {
      case WallMotion::kSideways:
        return SE3d(SO3d(), {way_ * 1.2 * swing(t, 20), 0, 0});
      case WallMotion::kForward:
        return SE3d(SO3d(), {0, 0, way_ * 0.6 * swing(t, 16)});
      case WallMotion::kTurning:
        return SE3d(
            SO3d::exp({0, way_ * 15 * kDegree * swing(t, 10), 0}) * SO3d::exp({6 * kDegree * swing(t, 7), 0, 0}),
            Vector3d::Zero());
      case WallMotion::kStanding:
        return SE3d();
      case WallMotion::kOrbit:
        return orbit(t, way_);
      case WallMotion::kSlow:
        return carried(slowed(t), way_);
    }
    return SE3d();
  }

 private:
  WallMotion motion_;
  double way_, duration_;
};

}  // namespace

WallMotion wall_motion_of(const std::string& name) {
  static const std::map<std::string, WallMotion> kNames = {
      {"sideways", WallMotion::kSideways}, {"forward", WallMotion::kForward}, {"turning", WallMotion::kTurning},
      {"standing", WallMotion::kStanding}, {"orbit", WallMotion::kOrbit},     {"slow", WallMotion::kSlow}};
  const auto found = kNames.find(name);
  if (found != kNames.end()) return found->second;
  throw Error("simulate", "there is no motion '" + name + "'",
              "choose sideways, forward, turning, standing, orbit or slow");
}

std::unique_ptr<CameraPath> make_wall_motion(WallMotion motion, double way, double duration) {
  return std::make_unique<WallPath>(motion, way, duration);
}

}  // namespace ldso::simulation
