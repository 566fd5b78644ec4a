#pragma once

// Idea: where the camera is at any time, smooth enough for blur and rolling shutter: a car on a round of streets, a
// hand-held camera along a spline, or a given trajectory.

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "ldso/io/trajectory_file.h"
#include "ldso/se3.h"

namespace ldso::simulation {

class CameraPath {
 public:
  virtual ~CameraPath() = default;
  /// Camera-to-world at a time in [0, duration()] [s]; continues smoothly a little outside of it.
  virtual SE3d pose(double t) const = 0;
  virtual double duration() const = 0;
};

/// Length of the way of the camera centre [m], sampled every 20 ms.
double path_length(const CameraPath& path);

/// A point of the centre line of a drive, y of the world down. Heading 0 looks along +z, positive turns to +x.
struct RoadPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< On the ground [m].
  double heading = 0;                                  ///< [rad]
  double s = 0;                                        ///< Arc length [m].
};

/// The closed way through the corners of a polygon, its corners rounded with a curvature that rises and falls smoothly
/// (as clothoids do), continued over its start by `overlap` [m]. Starts near the beginning of the first side; flat
/// ground. Throws Error if a side is too short for its corners.
std::vector<RoadPoint> round_trip(const std::vector<Eigen::Vector2d>& corners, double least_radius, double overlap,
                                  double step = 0.25);

struct DriveOptions {
  double speed = 10;            ///< On the straights [m/s].
  double lateral_limit = 4.5;   ///< Slows down in turns to keep the lateral acceleration below this [m/s^2].
  double camera_height = 1.65;  ///< Above the ground [m].
  bool suspension = true;       ///< Slight pitch, roll and heave.
  std::uint64_t seed = 1;
};
/// A car along a road.
std::unique_ptr<CameraPath> make_drive(std::vector<RoadPoint> road, const DriveOptions& options);

struct WalkOptions {
  double shake_rotation = 0.006;     ///< Standard deviation of the hand's tremor and sway [rad].
  double shake_translation = 0.004;  ///< [m]
  double step_frequency = 0;         ///< Of the steps [Hz]; 0: none.
  double step_height = 0.012;        ///< [m]
  double steps_begin = 0;            ///< Stands until then, then walks off within a second [s]; 0: walks at once.
  std::uint64_t seed = 1;
};
/// Where a hand-held camera is and what it looks at, at a time.
struct WalkPoint {
  double t = 0;
  Eigen::Vector3d position;
  Eigen::Vector3d target;
};
/// Smooth (cubic, twice differentiable) way through the points, with the motion of a hand on top.
std::unique_ptr<CameraPath> make_walk(const std::vector<WalkPoint>& points, const WalkOptions& options);

/// A given trajectory, interpolated smoothly between its poses. Throws Error if times do not increase.
std::unique_ptr<CameraPath> make_trajectory_path(const Trajectory& trajectory);

/// The road below a driven trajectory, camera `camera_height` above it; poses nearer than `step` to the last are left
/// out.
std::vector<RoadPoint> road_below(const Trajectory& trajectory, double camera_height, double step = 0.5);

/// Rotation of a camera that looks along `direction`, its x axis horizontal, y of the world being down.
SO3d look_along(const Eigen::Vector3d& direction);

}  // namespace ldso::simulation
