#pragma once

// Idea: a camera carried through a world, frame by frame, with everything about it known exactly. Frames can be asked
// for in any order and come out the same.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geometry/camera_model.h"
#include "image/frame.h"
#include "ldso/calibration.h"
#include "ldso/se3.h"
#include "simulation/rendering/ray_caster.h"
#include "simulation/rendering/sensor.h"
#include "simulation/worlds/world_builder.h"
#include "util/thread_pool.h"

namespace ldso::simulation {

struct SequenceOptions {
  CameraCalibration camera;
  /// What camera.txt proposes; without: none for a pinhole camera, else crop.
  std::optional<Rectification> rectification;
  SensorOptions sensor;
  double fps = 30;                  ///< Frames per second.
  int frames = 0;                   ///< At most this many; 0: the whole path.
  std::vector<double> timestamps;   ///< If given: the frames' times [s]; the first belongs to the path's start.
  bool provide_calibration = true;  ///< Whether calibration() contains response and vignette.
  bool provide_exposure = true;     ///< Whether frames say their exposure.
};

class SimulatedSequence {
 public:
  /// Throws Error if the camera is impossible or sees more than a half space.
  SimulatedSequence(World world, const SequenceOptions& options);

  int size() const { return static_cast<int>(times_.size()); }
  const Calibration& calibration() const { return calibration_; }
  const std::string& name() const { return world_.name; }
  const SequenceOptions& options() const { return options_; }

  double timestamp(int index) const { return start_ + times_[index]; }
  /// True exposure [ms], also if frames do not say it.
  double exposure_ms(int index) const { return exposures_[index]; }
  /// Camera-to-world at the timestamp: the middle of the exposure, of the middle row with a rolling shutter.
  SE3d T_world_camera(int index) const { return world_.path->pose(times_[index]); }
  /// Length of the way of the camera over all frames [m].
  double path_length() const;

  /// The image as a camera would give it. `pool` may be null; all functions can be called from several threads.
  RawFrame render(int index, ThreadPool* pool = nullptr) const;
  /// Irradiance t * B of each pixel (0..255; may exceed 255), with blur and rolling shutter, without vignette and
  /// noise.
  Image<float> irradiance(int index, ThreadPool* pool = nullptr) const;
  /// z [m] of what each pixel's centre of the raw image shows, at the timestamp's pose; 0 for the sky.
  Image<float> depth(int index, ThreadPool* pool = nullptr) const;
  /// The same through another camera at the same place, the rectified one for instance.
  Image<float> depth(int index, const PinholeIntrinsics& camera, ThreadPool* pool = nullptr) const;
  /// Irradiance through another camera at the same place, sharp.
  Image<float> irradiance(int index, const PinholeIntrinsics& camera, ThreadPool* pool = nullptr) const;

 private:
  void plan_exposures(const CameraModel& model);
  std::vector<SE3d> row_poses(int index, double offset) const;
  int blur_steps(int index) const;

  World world_;
  SequenceOptions options_;
  Calibration calibration_;
  Sensor sensor_;
  CameraRays rays_;
  double start_ = 0;
  std::vector<double> times_;      ///< On the path [s].
  std::vector<double> exposures_;  ///< [ms]
  double gain_ = 255;              ///< Irradiance of radiance 1 at the mean exposure.
};

}  // namespace ldso::simulation
