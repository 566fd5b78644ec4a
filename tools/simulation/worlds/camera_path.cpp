#include "simulation/worlds/camera_path.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "ldso/error.h"
#include "simulation/rendering/noise.h"
#include "simulation/worlds/smooth_step.h"

namespace ldso::simulation {
namespace {

/// Natural cubic spline through values at increasing times, three coordinates at once.
class CubicSpline {
 public:
  CubicSpline() = default;
  CubicSpline(std::vector<double> times, std::vector<Eigen::Vector3d> values)
      : times_(std::move(times)), values_(std::move(values)) {
    const int n = static_cast<int>(times_.size());
    if (n < 2) throw Error("camera path", "has fewer than two points", "give more");
    for (int i = 1; i < n; ++i) {
      if (times_[i] <= times_[i - 1]) throw Error("camera path", "times do not increase", "sort the points by time");
    }
    solve_curvatures();
  }

  Eigen::Vector3d at(double t) const {
    const auto next = std::upper_bound(times_.begin() + 1, times_.end() - 1, t);
    const auto i = static_cast<std::size_t>(next - times_.begin()) - 1;
    const double h = times_[i + 1] - times_[i], a = (times_[i + 1] - t) / h, b = 1 - a;
    return a * values_[i] + b * values_[i + 1] +
           ((a * a * a - a) * curvatures_[i] + (b * b * b - b) * curvatures_[i + 1]) * (h * h / 6);
  }
  double end() const { return times_.back(); }

 private:
  /// Second derivatives at the knots, by elimination in the tridiagonal system.
  void solve_curvatures() {
    const int n = static_cast<int>(times_.size());
    curvatures_.assign(n, Eigen::Vector3d::Zero());
    std::vector<double> upper(n, 0.0);
    for (int i = 1; i + 1 < n; ++i) {
      const double before = times_[i] - times_[i - 1], after = times_[i + 1] - times_[i];
      const double pivot = 2 * (before + after) - before * upper[i - 1];
      upper[i] = after / pivot;
      const Eigen::Vector3d right =
          6 * ((values_[i + 1] - values_[i]) / after - (values_[i] - values_[i - 1]) / before);
      curvatures_[i] = (right - before * curvatures_[i - 1]) / pivot;
    }
    for (int i = n - 2; i > 0; --i) curvatures_[i] -= upper[i] * curvatures_[i + 1];
  }

  std::vector<double> times_;
  std::vector<Eigen::Vector3d> values_;
  std::vector<Eigen::Vector3d> curvatures_;
};

Eigen::Vector3d heading_vector(double heading) { return {std::sin(heading), 0, std::cos(heading)}; }

/// A turn by `angle` whose curvature rises, stays and falls; `least_radius` at its sharpest.
struct Corner {
  double angle = 0;
  double length = 0;
  double tangent = 0;  ///< Distance from the polygon's corner to where the turn begins.

  static constexpr double kRamp = 0.35;  ///< Part of the length in which the curvature rises, and falls.

  Corner(double turn, double least_radius) : angle(turn) {
    length = std::abs(angle) * least_radius / (1 - kRamp);
    if (length <= 0) return;
    // Chord of the turn; by symmetry it makes half of the angle with both sides.
    Eigen::Vector2d end = Eigen::Vector2d::Zero();
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i) {
      const double h = heading((i + 0.5) * length / kSteps);
      end += Eigen::Vector2d(std::sin(h), std::cos(h)) * (length / kSteps);
    }
    tangent = end.norm() / (2 * std::cos(0.5 * angle));
  }

  /// Turned angle after `s` metres.
  double heading(double s) const {
    const double x = std::clamp(s / length, 0.0, 1.0);
    // Integral of the trapezoid with smooth (raised cosine) flanks.
    const auto flank = [](double p) {  // Integral of (1 - cos(pi q)) / 2 from 0 to p.
      return 0.5 * (p - std::sin(std::numbers::pi * p) / std::numbers::pi);
    };
    double integral = 0;
    if (x < kRamp) {
      integral = kRamp * flank(x / kRamp);
    } else if (x <= 1 - kRamp) {
      integral = 0.5 * kRamp + (x - kRamp);
    } else {
      integral = (1 - kRamp) - kRamp * flank((1 - x) / kRamp);
    }
    return angle * integral / (1 - kRamp);
  }
};

double wrap_angle(double a) { return std::remainder(a, 2 * std::numbers::pi); }

class Drive : public CameraPath {
 public:
  Drive(std::vector<RoadPoint> road, const DriveOptions& options)
      : road_(std::move(road)),
        options_(options),
        pitch_(hash_of(options.seed, 1), 1.1),
        roll_(hash_of(options.seed, 2), 0.8),
        heave_(hash_of(options.seed, 3), 1.4),
        wander_(hash_of(options.seed, 4), 0.12) {
    if (road_.size() < 4) throw Error("drive", "the road has fewer than four points", "give a longer one");
    unwrap_headings();
    schedule();
  }

  double duration() const override { return times_.back(); }

  SE3d pose(double t) const override {
    Eigen::Vector3d position;
    double heading = 0;
    interpolate(t, position, heading);
    const Eigen::Vector3d right(std::cos(heading), 0, -std::sin(heading));
    // The driver wanders in the lane by some centimetres; the heading follows.
    position += 0.12 * wander_.at(t) * right;
    const double wander_speed = 0.12 * (wander_.at(t + 0.05) - wander_.at(t - 0.05)) / 0.1;
    const double yaw = heading + wander_speed / options_.speed;
    double pitch = 0, roll = 0, heave = 0;
    if (options_.suspension) {
      pitch = 0.004 * pitch_.at(t);
      roll = 0.003 * roll_.at(t);
      heave = 0.008 * heave_.at(t);
    }
    position.y() += heave - options_.camera_height;
    const SO3d R = SO3d::exp({0, yaw, 0}) * SO3d::exp({pitch, 0, 0}) * SO3d::exp({0, 0, roll});
    return SE3d(R, position);
  }

 private:
  void unwrap_headings() {
    for (std::size_t i = 1; i < road_.size(); ++i) {
      road_[i].heading = road_[i - 1].heading + wrap_angle(road_[i].heading - road_[i - 1].heading);
    }
  }

  /// Speeds limited by the turns, brakes and engine; then the time of each road point.
  void schedule() {
    const std::size_t n = road_.size();
    std::vector<double> speed(n, options_.speed);
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const double curvature =
          std::abs(road_[i + 1].heading - road_[i - 1].heading) / (road_[i + 1].s - road_[i - 1].s);
      if (curvature > 1e-6) speed[i] = std::min(speed[i], std::sqrt(options_.lateral_limit / curvature));
    }
    constexpr double kAcceleration = 1.5;
    for (std::size_t i = 1; i < n; ++i) {
      const double step = road_[i].s - road_[i - 1].s;
      speed[i] = std::min(speed[i], std::sqrt(speed[i - 1] * speed[i - 1] + 2 * kAcceleration * step));
    }
    for (std::size_t i = n - 1; i > 0; --i) {
      const double step = road_[i].s - road_[i - 1].s;
      speed[i - 1] = std::min(speed[i - 1], std::sqrt(speed[i] * speed[i] + 2 * kAcceleration * step));
    }
    times_.assign(n, 0.0);
    for (std::size_t i = 1; i < n; ++i) {
      times_[i] = times_[i - 1] + 2 * (road_[i].s - road_[i - 1].s) / (speed[i] + speed[i - 1]);
    }
  }

  /// Cubic (Catmull-Rom) between the road points, which lie densely.
  void interpolate(double t, Eigen::Vector3d& position, double& heading) const {
    const auto next = std::upper_bound(times_.begin() + 1, times_.end() - 1, t);
    const auto i = static_cast<std::size_t>(next - times_.begin()) - 1;
    const double h = times_[i + 1] - times_[i], x = (t - times_[i]) / h;
    const std::size_t before = i > 0 ? i - 1 : i, after = std::min(i + 2, road_.size() - 1);
    const auto blend = [&](auto p0, auto p1, auto p2, auto p3) {
      const auto m1 = (p2 - p0) * (h / (times_[i + 1] - times_[before]));
      const auto m2 = (p3 - p1) * (h / (times_[after] - times_[i]));
      const double x2 = x * x, x3 = x2 * x;
      return p1 * (2 * x3 - 3 * x2 + 1) + m1 * (x3 - 2 * x2 + x) + p2 * (3 * x2 - 2 * x3) + m2 * (x3 - x2);
    };
    for (int k = 0; k < 3; ++k) {
      position[k] =
          blend(road_[before].position[k], road_[i].position[k], road_[i + 1].position[k], road_[after].position[k]);
    }
    heading = blend(road_[before].heading, road_[i].heading, road_[i + 1].heading, road_[after].heading);
  }

  std::vector<RoadPoint> road_;
  DriveOptions options_;
  std::vector<double> times_;
  SmoothNoise pitch_, roll_, heave_, wander_;
};

class Walk : public CameraPath {
 public:
  Walk(const std::vector<WalkPoint>& points, const WalkOptions& options) : options_(options) {
    std::vector<double> times;
    std::vector<Eigen::Vector3d> positions, targets;
    for (const WalkPoint& p : points) {
      times.push_back(p.t);
      positions.push_back(p.position);
      targets.push_back(p.target);
    }
    positions_ = CubicSpline(times, std::move(positions));
    targets_ = CubicSpline(std::move(times), std::move(targets));
    for (std::uint64_t i = 0; i < 6; ++i) {
      sway_.emplace_back(hash_of(options.seed, 10 + i), 0.5);
      tremor_.emplace_back(hash_of(options.seed, 20 + i), 3.0);
    }
  }

  double duration() const override { return positions_.end(); }

  SE3d pose(double t) const override {
    Eigen::Vector3d position = positions_.at(t);
    const Eigen::Vector3d shift(shake(0, t), shake(1, t), shake(2, t)), turn(shake(3, t), shake(4, t), shake(5, t));
    position += options_.shake_translation * shift;
    if (options_.step_frequency > 0) {
      position.y() += walking(t) * options_.step_height * std::sin(2 * std::numbers::pi * options_.step_frequency * t);
    }
    const SO3d R = look_along(targets_.at(t) - positions_.at(t));
    return SE3d(R * SO3d::exp(options_.shake_rotation * turn), position);
  }

 private:
  double shake(int axis, double t) const { return 2.0 * sway_[axis].at(t) + 0.12 * tremor_[axis].at(t); }

  /// 0 before the first step, 1 from a second after it.
  double walking(double t) const {
    if (options_.steps_begin <= 0) return 1;
    return smooth_step(options_.steps_begin, options_.steps_begin + 1, t);
  }

  WalkOptions options_;
  CubicSpline positions_, targets_;
  std::vector<SmoothNoise> sway_, tremor_;
};

/// Positions by a natural cubic spline; rotations by a cumulative cubic B-spline-like blend of neighbouring relative
/// rotations (Catmull-Rom on the rotation vectors relative to the middle pose), exact at the given times.
class GivenTrajectory : public CameraPath {
 public:
  explicit GivenTrajectory(const Trajectory& trajectory) : poses_(trajectory) {
    std::vector<double> times;
    std::vector<Eigen::Vector3d> positions;
    for (const StampedPose& pose : trajectory) {
      times.push_back(pose.timestamp - trajectory.front().timestamp);
      positions.push_back(pose.T_world_camera.translation());
    }
    times_ = times;
    positions_ = CubicSpline(std::move(times), std::move(positions));
  }

  double duration() const override { return times_.back(); }

  SE3d pose(double t) const override {
    const auto next = std::upper_bound(times_.begin() + 1, times_.end() - 1, t);
    const auto i = static_cast<std::size_t>(next - times_.begin()) - 1;
    const double h = times_[i + 1] - times_[i], x = (t - times_[i]) / h;
    const std::size_t before = i > 0 ? i - 1 : i, after = std::min(i + 2, times_.size() - 1);
    const SO3d R_i = rotation(i);
    const auto relative = [&](std::size_t k) { return (R_i.inverse() * rotation(k)).log(); };
    const Eigen::Vector3d r0 = relative(before), r2 = relative(i + 1), r3 = relative(after);
    const Eigen::Vector3d m1 = (r2 - r0) * (h / (times_[i + 1] - times_[before]));
    const Eigen::Vector3d m2 = r3 * (h / (times_[after] - times_[i]));
    const double x2 = x * x, x3 = x2 * x;
    const Eigen::Vector3d turn = m1 * (x3 - 2 * x2 + x) + r2 * (3 * x2 - 2 * x3) + m2 * (x3 - x2);
    return SE3d(R_i * SO3d::exp(turn), positions_.at(t));
  }

 private:
  SO3d rotation(std::size_t i) const { return poses_[i].T_world_camera.rotation(); }

  Trajectory poses_;
  std::vector<double> times_;
  CubicSpline positions_;
};

}  // namespace

double path_length(const CameraPath& path) {
  double length = 0;
  Eigen::Vector3d last = path.pose(0).translation();
  const int steps = static_cast<int>(path.duration() / 0.02);
  for (int i = 1; i <= steps; ++i) {
    const Eigen::Vector3d position = path.pose(i * 0.02).translation();
    length += (position - last).norm();
    last = position;
  }
  return length;
}

std::vector<RoadPoint> round_trip(const std::vector<Eigen::Vector2d>& corners, double least_radius, double overlap,
                                  double step) {
  const std::size_t n = corners.size();
  if (n < 3) throw Error("round trip", "needs three corners", "");
  const auto side = [&](std::size_t i) -> Eigen::Vector2d { return corners[(i + 1) % n] - corners[i % n]; };
  const auto direction = [&](std::size_t i) { return std::atan2(side(i).x(), side(i).y()); };
  std::vector<Corner> turns;  // turns[i] lies at the end of side i.
  for (std::size_t i = 0; i < n; ++i) turns.emplace_back(wrap_angle(direction(i + 1) - direction(i)), least_radius);
  // Starts a few metres after the last turn; goes along side 0, turn 0, side 1, ..., turn n-1, and over the start.
  constexpr double kRunUp = 4;
  std::vector<RoadPoint> road;
  RoadPoint point;
  const Eigen::Vector2d start = corners[0] + (turns[n - 1].tangent + kRunUp) * side(0).normalized();
  point.position = {start.x(), 0, start.y()};
  point.heading = direction(0);
  const auto advance = [&](double length, const Corner* turn) {
    const double first = point.heading;
    const int steps = std::max(1, static_cast<int>(std::lround(length / step)));
    const double ds = length / steps;
    for (int i = 0; i < steps; ++i) {
      road.push_back(point);
      const double middle = turn != nullptr ? first + turn->heading((i + 0.5) * ds) : first;
      point.position += ds * heading_vector(middle);
      point.heading = turn != nullptr ? first + turn->heading((i + 1) * ds) : first;
      point.s += ds;
    }
  };
  for (std::size_t i = 0; i <= n; ++i) {
    const double before = turns[(i + n - 1) % n].tangent, after = turns[i % n].tangent;
    const double whole = side(i).norm() - before - after;
    const double straight = i == 0 ? whole - kRunUp : i == n ? kRunUp + overlap : whole;
    if (i == n && straight > whole) throw Error("round trip", "overlaps its start beyond the first corner", "use less");
    if (straight < 1) throw Error("round trip", "a side is too short for its corners", "make it larger");
    advance(straight, nullptr);
    if (i < n) advance(turns[i].length, &turns[i]);
  }
  road.push_back(point);
  return road;
}

std::unique_ptr<CameraPath> make_drive(std::vector<RoadPoint> road, const DriveOptions& options) {
  return std::make_unique<Drive>(std::move(road), options);
}

std::unique_ptr<CameraPath> make_walk(const std::vector<WalkPoint>& points, const WalkOptions& options) {
  return std::make_unique<Walk>(points, options);
}

std::unique_ptr<CameraPath> make_trajectory_path(const Trajectory& trajectory) {
  return std::make_unique<GivenTrajectory>(trajectory);
}

std::vector<RoadPoint> road_below(const Trajectory& trajectory, double camera_height, double step) {
  std::vector<RoadPoint> road;
  for (const StampedPose& pose : trajectory) {
    RoadPoint point;
    const SE3d& T = pose.T_world_camera;
    point.position = T.translation() + Eigen::Vector3d(0, camera_height, 0);
    const Eigen::Vector3d forward = T.rotation() * Eigen::Vector3d::UnitZ();
    point.heading = std::atan2(forward.x(), forward.z());
    if (!road.empty()) {
      const double moved = (point.position - road.back().position).norm();
      if (moved < step) continue;
      point.s = road.back().s + moved;
    }
    road.push_back(point);
  }
  return road;
}

SO3d look_along(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d z = direction.normalized();
  const Eigen::Vector3d x = Eigen::Vector3d::UnitY().cross(z).normalized();
  Eigen::Matrix3d R;
  R.col(0) = x;
  R.col(1) = z.cross(x);
  R.col(2) = z;
  return SO3d::from_matrix(R);
}

}  // namespace ldso::simulation
