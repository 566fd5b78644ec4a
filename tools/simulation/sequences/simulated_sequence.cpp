#include "simulation/sequences/simulated_sequence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ldso/error.h"
#include "simulation/rendering/noise.h"

namespace ldso::simulation {
namespace {

constexpr double kMeanIrradiance = 95;  ///< What the automatic exposure aims at.

CameraRays rays_of(const CameraModel& model, double scale = 1) {
  const int width = std::max(2, static_cast<int>(model.calibration().width * scale)),
            height = std::max(2, static_cast<int>(model.calibration().height * scale));
  const double step_x = static_cast<double>(model.calibration().width) / width,
               step_y = static_cast<double>(model.calibration().height) / height;
  return CameraRays(width, height, [&](double u, double v) -> Eigen::Vector2d {
    const auto ray = model.unproject({(u + 0.5) * step_x - 0.5, (v + 0.5) * step_y - 0.5});
    if (!ray) return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
    return ray->head<2>() / ray->z();
  });
}

CameraRays rays_of(const PinholeIntrinsics& camera) {
  return CameraRays(camera.width, camera.height, [&](double u, double v) -> Eigen::Vector2d {
    return {(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy};
  });
}

Calibration calibration_of(const SequenceOptions& options) {
  Calibration calibration;
  calibration.camera = options.camera;
  calibration.description = "simulated";
  if (options.rectification) {
    calibration.rectification = *options.rectification;
    return calibration;
  }
  const bool pinhole = options.camera.model == CameraModelKind::kPinhole;
  calibration.rectification.mode = pinhole ? RectificationMode::kNone : RectificationMode::kCrop;
  calibration.rectification.width = options.camera.width;
  calibration.rectification.height = options.camera.height;
  return calibration;
}

double mean_of(const Image<float>& image) {
  double sum = 0;
  for (std::size_t i = 0; i < image.size(); ++i) sum += image.data()[i];
  return sum / static_cast<double>(image.size());
}

void scale(Image<float>& image, double factor) {
  for (std::size_t i = 0; i < image.size(); ++i) image.data()[i] *= static_cast<float>(factor);
}

std::vector<double> frame_times(const World& world, const SequenceOptions& options) {
  std::vector<double> times;
  if (!options.timestamps.empty()) {
    for (const double t : options.timestamps) times.push_back(t - options.timestamps.front());
  } else {
    if (!(options.fps > 0)) throw Error("simulation", "the frame rate is not positive", "give --fps above 0");
    const auto count = static_cast<int>(std::floor(world.path->duration() * options.fps + 1e-9)) + 1;
    for (int i = 0; i < count; ++i) times.push_back(i / options.fps);
  }
  if (options.frames > 0 && options.frames < static_cast<int>(times.size())) times.resize(options.frames);
  return times;
}

}  // namespace

SimulatedSequence::SimulatedSequence(World world, const SequenceOptions& options)
    : world_(std::move(world)),
      options_(options),
      calibration_(calibration_of(options)),
      sensor_(options.sensor, options.camera.width, options.camera.height),
      rays_(rays_of(*make_camera_model(options.camera))),
      start_(options.timestamps.empty() ? 0 : options.timestamps.front()),
      times_(frame_times(world_, options)) {
  if (options_.provide_calibration) calibration_.photometric = sensor_.calibration();
  plan_exposures(*make_camera_model(options.camera));
}

/// An automatic exposure, slow as in real cameras, from thumbnails of every few frames; on top it wanders.
void SimulatedSequence::plan_exposures(const CameraModel& model) {
  const CameraRays thumbnail = rays_of(model, 40.0 / options_.camera.width);
  const RayCaster caster(world_.scene, thumbnail);
  // A thumbnail every quarter of a second.
  const double step = size() > 1 ? (times_.back() - times_.front()) / (size() - 1) : 1.0;
  const int stride = std::max(1, static_cast<int>(std::lround(0.25 / step)));
  std::vector<double> means;
  double sum = 0;
  for (int i = 0; i < size(); i += stride) {
    Image<float> radiance;
    caster.render({T_world_camera(i)}, {&radiance, nullptr}, nullptr);
    means.push_back(std::max(mean_of(radiance), 0.02));
    sum += means.back();
  }
  const double overall = sum / static_cast<double>(means.size());
  gain_ = kMeanIrradiance * world_.light / overall;
  exposures_.assign(size(), options_.sensor.exposure_ms);
  if (!options_.sensor.exposure_changes) return;
  const SmoothNoise wander(hash_of(options_.sensor.seed, 0xe), 0.09);
  for (int i = 0; i < size(); ++i) {
    double weight = 0, mean = 0;
    for (int k = 0; k < static_cast<int>(means.size()); ++k) {
      const double distance = (times_[std::min(k * stride, size() - 1)] - times_[i]) / 0.8;
      if (std::abs(distance) > 4) continue;
      const double w = std::exp(-0.5 * distance * distance);
      weight += w;
      mean += w * means[k];
    }
    const double automatic = weight > 0 ? std::pow(overall / (mean / weight), 0.8) : 1.0;
    exposures_[i] = options_.sensor.exposure_ms * automatic * std::exp(0.15 * wander.at(times_[i]));
  }
}

double SimulatedSequence::path_length() const {
  double length = 0;
  for (int i = 1; i < size(); ++i) {
    length += (T_world_camera(i).translation() - T_world_camera(i - 1).translation()).norm();
  }
  return length;
}

std::vector<SE3d> SimulatedSequence::row_poses(int index, double offset) const {
  const double t = times_[index] + offset, readout = options_.sensor.rolling_shutter_ms * 1e-3;
  if (readout <= 0) return {world_.path->pose(t)};
  std::vector<SE3d> poses;
  const int height = options_.camera.height;
  for (int row = 0; row < height; ++row) {
    poses.push_back(world_.path->pose(t + readout * ((row + 0.5) / height - 0.5)));
  }
  return poses;
}

/// As many as the image moves pixels during the exposure, for things 1.5 m away or at infinity.
int SimulatedSequence::blur_steps(int index) const {
  if (!options_.sensor.motion_blur) return 1;
  const double half = 0.5e-3 * exposures_[index];
  const SE3d motion = world_.path->pose(times_[index] - half).inverse() * world_.path->pose(times_[index] + half);
  double most = 0;
  for (const double x : {-0.6, 0.6}) {
    for (const double z : {1.5, 1000.0}) {
      const Eigen::Vector3d p = motion * Eigen::Vector3d(x * z, 0.4 * x * z, z);
      if (p.z() <= 0) return 16;
      const Eigen::Vector2d moved(p.x() / p.z() - x, p.y() / p.z() - 0.4 * x);
      most = std::max(most, options_.camera.fx * moved.norm());
    }
  }
  return std::clamp(static_cast<int>(std::ceil(1.5 * most)) + 1, 1, 16);
}

Image<float> SimulatedSequence::irradiance(int index, ThreadPool* pool) const {
  const RayCaster caster(world_.scene, rays_);
  const int steps = blur_steps(index);
  Image<float> sum;
  for (int step = 0; step < steps; ++step) {
    Image<float> radiance;
    const double offset = ((step + 0.5) / steps - 0.5) * 1e-3 * exposures_[index];
    caster.render(row_poses(index, steps > 1 ? offset : 0), {&radiance, nullptr}, pool);
    if (step == 0) {
      sum = std::move(radiance);
    } else {
      for (std::size_t i = 0; i < sum.size(); ++i) sum.data()[i] += radiance.data()[i];
    }
  }
  scale(sum, gain_ * exposures_[index] / options_.sensor.exposure_ms / steps);
  return sum;
}

RawFrame SimulatedSequence::render(int index, ThreadPool* pool) const {
  RawFrame frame;
  frame.id = index;
  frame.timestamp = timestamp(index);
  if (options_.provide_exposure) frame.exposure_ms = exposures_[index];
  frame.grey = sensor_.expose(irradiance(index, pool), index);
  frame.name = world_.name + " frame " + std::to_string(index);
  return frame;
}

Image<float> SimulatedSequence::depth(int index, ThreadPool* pool) const {
  Image<float> depth;
  RayCaster(world_.scene, rays_).render({T_world_camera(index)}, {nullptr, &depth}, pool);
  return depth;
}

Image<float> SimulatedSequence::depth(int index, const PinholeIntrinsics& camera, ThreadPool* pool) const {
  const CameraRays rays = rays_of(camera);
  Image<float> depth;
  RayCaster(world_.scene, rays).render({T_world_camera(index)}, {nullptr, &depth}, pool);
  return depth;
}

Image<float> SimulatedSequence::irradiance(int index, const PinholeIntrinsics& camera, ThreadPool* pool) const {
  const CameraRays rays = rays_of(camera);
  Image<float> radiance;
  RayCaster(world_.scene, rays).render({T_world_camera(index)}, {&radiance, nullptr}, pool);
  scale(radiance, gain_ * exposures_[index] / options_.sensor.exposure_ms);
  return radiance;
}

}  // namespace ldso::simulation
