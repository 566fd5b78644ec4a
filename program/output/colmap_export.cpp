#include "output/colmap_export.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "geometry/camera_model.h"
#include "geometry/pinhole_projection.h"
#include "imagery/frame_images.h"
#include "io/images/image_file.h"
#include "io/text/output_folder.h"
#include "ldso/error.h"
#include "ldso/io/ply_file.h"
#include "output/frame_choice.h"
#include "output/model_images.h"
#include "output/point_tracks.h"
#include "output/transforms_json.h"
#include "util/format_text.h"
#include "util/median.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCloudName = "points.ply";

CameraCalibration pinhole(const PinholeIntrinsics& camera) {
  return {CameraModelKind::kPinhole, camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy, {}};
}

bool is_inside(const Eigen::Vector2d& pixel, const CameraCalibration& camera) {
  return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < camera.width - 0.5 && pixel.y() < camera.height - 0.5;
}

std::vector<FramePose> chosen_frames(const FrameImages& images, const PlacedMap& placed, const Dataset& sequence,
                                     int count) {
  const auto sharpness_of = [&](std::size_t i) {
    return sharpness(sequence.read(static_cast<int>(images.frames()[i].id)).grey.view());
  };
  std::vector<FramePose> chosen;
  for (const std::size_t i :
       choose_frames(images.frames(), median_depth(placed), static_cast<std::size_t>(count), sharpness_of))
    chosen.push_back(images.frames()[i]);
  return chosen;
}

/// Grows image by image.
class MeasuredModel {
 public:
  /// `images`: where pixels are measured, must outlive this; `original`: the camera of the images that are written, if
  /// they are others.
  MeasuredModel(const FrameImages& images, const CameraCalibration* original, const PointTracks& tracks)
      : images_(images), lens_(original != nullptr ? make_camera_model(*original) : nullptr) {
    model_.camera = original != nullptr ? *original : pinhole(images.camera());
    for (std::size_t i = 0; i < tracks.positions().size(); ++i)
      model_.points.push_back({tracks.positions()[i], tracks.intensities()[i], tracks.colors()[i]});
    errors_.resize(model_.points.size(), 0);
    counts_.resize(model_.points.size(), 0);
  }

  void add(std::string name, const SE3d& T_world_camera, const std::vector<Sighting>& sightings) {
    ColmapImage image{std::move(name), T_world_camera, {}};
    for (const Sighting& sighting : sightings) {
      // Where the image shows the point, and where the camera of the model says it should.
      const Eigen::Vector2d seen = to_written(images_.image_camera(), sighting.seen);
      const Eigen::Vector2d predicted = to_written(images_.camera(), sighting.predicted);
      if (!seen.allFinite() || !predicted.allFinite() || !is_inside(seen, model_.camera)) continue;
      image.observations.push_back({seen, sighting.point});
      errors_[sighting.point] += (seen - predicted).norm();
      ++counts_[sighting.point];
    }
    model_.images.push_back(std::move(image));
  }

  ColmapModel finish() {
    for (std::size_t i = 0; i < model_.points.size(); ++i) {
      if (counts_[i] > 0) model_.points[i].error = errors_[i] / counts_[i];
    }
    return std::move(model_);
  }

 private:
  /// A pixel of a rectified image of `camera` in the images that are written.
  Eigen::Vector2d to_written(const PinholeIntrinsics& camera, const Eigen::Vector2d& pixel) const {
    return lens_ ? lens_->project(viewing_ray(camera, pixel)) : pixel;
  }

  const FrameImages& images_;
  std::unique_ptr<CameraModel> lens_;  ///< Null if the written images are the rectified ones.
  ColmapModel model_;
  std::vector<double> errors_;  ///< Sums, by point.
  std::vector<int> counts_;
};

TrackedImage tracked_image(const FrameImages& images, const FramePose& frame, bool corrected) {
  const ReadoutMotion motion = corrected ? ReadoutMotion(ReadoutMotion::Zero()) : images.motion(frame.id);
  return {frame.id, frame.T_world_camera, motion, images.rectified(frame.id, corrected)};
}

/// Writes the images and measures in them where the points are.
ColmapModel measure_model(const FrameImages& images, const Dataset& sequence, const PlacedMap& placed,
                          const std::vector<FramePose>& frames, ColmapImages kind, const fs::path& folder) {
  const bool is_original = kind == ColmapImages::kOriginal;
  PointTracks tracks(placed, images.camera());
  const std::vector<FramePose> keyframes = keyframes_of(placed);
  for (std::size_t i = 0; i < keyframes.size(); ++i)
    tracks.add_keyframe(i, tracked_image(images, keyframes[i], !is_original));
  MeasuredModel model(images, is_original ? &sequence.calibration().camera : nullptr, tracks);
  create_folder(folder);
  for (const FramePose& frame : frames) {
    const TrackedImage image = tracked_image(images, frame, !is_original);
    std::string name = model_image_name(frame.id);
    if (is_original) {
      name = copy_model_image(sequence, frame.id, folder);
    } else {
      write_png(folder / name, image.image.view());
    }
    model.add(std::move(name), frame.T_world_camera, tracks.find(image));
  }
  return model.finish();
}

std::string shutter_note(const FrameImages& images, const std::vector<FramePose>& frames, double readout_ms,
                         bool is_corrected) {
  std::vector<double> medians;
  double largest = 0;
  for (const FramePose& frame : frames) {
    const ShutterShift shift = images.shift(frame.id);
    medians.push_back(shift.median);
    largest = std::max(largest, shift.largest);
  }
  const double usual = medians.empty() ? 0 : median_of(std::move(medians));
  const std::string what = is_corrected ? "is undone in the images: it had displaced points"
                                        : "is ignored, which --images rectified would not do: it displaces points";
  return format_text("the rolling shutter of %.1f ms %s by %.2f px in the middle image, at most by %.2f px", readout_ms,
                     what.c_str(), usual, largest);
}

std::string track_note(const ColmapModel& model) {
  std::size_t points = 0, observations = 0;
  double error = 0;
  for (const ColmapImage& image : model.images) observations += image.observations.size();
  for (const ColmapPoint& point : model.points) {
    if (!(point.error >= 0)) continue;
    ++points;
    error += point.error;
  }
  if (points == 0) return "no image shows a point of the map";
  const auto count = static_cast<double>(points);
  return format_text("%zu images, %zu points, each found in %.1f images, %.2f px from where it should be on average",
                     model.images.size(), points, static_cast<double>(observations) / count, error / count);
}

/// Those that the model has: what no image shows is in none of its files.
void write_cloud(const fs::path& path, const ColmapModel& model) {
  std::vector<bool> is_seen(model.points.size(), false);
  for (const ColmapImage& image : model.images) {
    for (const ColmapObservation& seen : image.observations) is_seen[seen.point] = true;
  }
  std::vector<PlyPoint> cloud;
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    if (!is_seen[i]) continue;
    const Eigen::Vector3f p = model.points[i].position.cast<float>();
    cloud.push_back({p.x(), p.y(), p.z(), model.points[i].intensity, 0, model.points[i].color});
  }
  write_ply(path, cloud);
}

void write_model(const fs::path& folder, const ColmapModel& model) {
  write_colmap_model(folder / "sparse" / "0", model);
  write_cloud(folder / kCloudName, model);
}

}  // namespace

std::vector<FramePose> keyframes_of(const PlacedMap& placed) {
  std::vector<FramePose> frames;
  for (std::size_t i = 0; i < placed.poses.size(); ++i) {
    const protocol::Keyframe& keyframe = placed.map.keyframes[i];
    frames.push_back({keyframe.id, keyframe.timestamp, placed.T_world_camera(i)});
  }
  return frames;
}

ColmapModel predicted_colmap_model(const PlacedMap& placed, const std::vector<FramePose>& frames,
                                   const CameraCalibration& camera, const std::vector<std::string>& names) {
  const auto lens = make_camera_model(camera);
  const std::vector<FrameSpan> seen_by = window_spans(placed.map);
  ColmapModel model;
  model.camera = camera;
  for (std::size_t i = 0; i < frames.size(); ++i) model.images.push_back({names[i], frames[i].T_world_camera, {}});
  for (std::size_t i = 0; i < placed.poses.size(); ++i) {
    const protocol::Keyframe& keyframe = placed.map.keyframes[i];
    for (std::size_t k = 0; k < keyframe.points.size(); ++k) {
      if (!(keyframe.depth_stddev[k] <= placed.most_deviation)) continue;
      const Eigen::Vector3d position = placed.poses[i] * keyframe.points[k].cast<double>();
      for (std::size_t other = 0; other < frames.size(); ++other) {
        if (!seen_by[i].contains(frames[other].id)) continue;
        const Eigen::Vector3d in_camera = frames[other].T_world_camera.inverse() * position;
        if (!(in_camera.z() > 0)) continue;
        const Eigen::Vector2d pixel = lens->project(in_camera);
        if (pixel.allFinite() && is_inside(pixel, camera))
          model.images[other].observations.push_back({pixel, model.points.size()});
      }
      model.points.push_back({position, keyframe.intensity[k]});
      if (!keyframe.colors.empty()) model.points.back().color = keyframe.colors[k];
    }
  }
  return model;
}

std::vector<std::string> export_colmap(const fs::path& folder, const FinishedRun& run, const PlacedMap& placed,
                                       const Trajectory& trajectory, const ColmapOptions& options) {
  if (options.images == ColmapImages::kNone) {
    const std::vector<FramePose> frames = keyframes_of(placed);
    std::vector<std::string> names;
    for (const FramePose& frame : frames) names.push_back(model_image_name(frame.id));
    write_model(folder, predicted_colmap_model(placed, frames, pinhole(run.camera), names));
    return {"without images nothing was measured: errors of reprojection are given as -1"};
  }
  const std::unique_ptr<Dataset> sequence = open_sequence(run);
  const CameraCalibration& lens = sequence->calibration().camera;
  const bool is_original = options.images == ColmapImages::kOriginal;
  if (is_original) colmap_camera(lens);  // What the format cannot hold is said before anything is written.
  const FrameImages images(*sequence, sequence->calibration(), run.camera, placed, posed_frames(trajectory, *sequence));
  const std::vector<FramePose> frames =
      options.count ? chosen_frames(images, placed, *sequence, *options.count) : keyframes_of(placed);
  const ColmapModel model = measure_model(images, *sequence, placed, frames, options.images, folder / "images");
  write_model(folder, model);
  std::vector<std::string> notes{track_note(model)};
  if (has_transforms_lens(model.camera)) {
    write_transforms_json(folder / "transforms.json", model, "images", kCloudName);
  } else {
    notes.push_back("transforms.json is not written: it has no lens like this one; --images rectified needs none");
  }
  if (images.has_rolling_shutter()) notes.push_back(shutter_note(images, frames, lens.readout_ms, !is_original));
  return notes;
}

}  // namespace ldso
