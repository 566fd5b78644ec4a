#include "output/colmap_export.h"

#include <cstdio>
#include <map>
#include <set>
#include <system_error>

#include "geometry/camera_model.h"
#include "image/frame_preprocessor.h"
#include "io/images/image_file.h"
#include "io/text/output_folder.h"
#include "ldso/error.h"
#include "util/format_text.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

/// For each keyframe those, itself first, that shared the window with it.
std::vector<std::vector<std::size_t>> companions(const RecordedMap& map) {
  std::map<std::int64_t, std::size_t> index_of;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) index_of[map.keyframes[i].id] = i;
  std::vector<std::set<std::size_t>> sets(map.keyframes.size());
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    for (const std::int64_t id : map.keyframes[i].links) {
      const auto other = index_of.find(id);
      if (other == index_of.end() || other->second == i) continue;
      sets[i].insert(other->second);
      sets[other->second].insert(i);
    }
  }
  std::vector<std::vector<std::size_t>> lists(sets.size());
  for (std::size_t i = 0; i < sets.size(); ++i) {
    lists[i].push_back(i);
    lists[i].insert(lists[i].end(), sets[i].begin(), sets[i].end());
  }
  return lists;
}

bool is_inside(const Eigen::Vector2d& pixel, const CameraCalibration& camera) {
  return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() < camera.width - 0.5 && pixel.y() < camera.height - 0.5;
}

std::string image_name(std::int64_t frame_id) { return format_text("%06lld.png", static_cast<long long>(frame_id)); }

/// The image of a frame as a file of its own, under its own name if it is one already.
std::string write_original(const Dataset& dataset, std::int64_t frame_id, const fs::path& folder) {
  const RawFrame frame = dataset.read(static_cast<int>(frame_id));
  const fs::path source = frame.name;
  std::error_code error;
  if (fs::is_regular_file(source, error) && has_image_extension(source)) {
    fs::copy_file(source, folder / source.filename(), fs::copy_options::overwrite_existing, error);
    if (error) {
      throw Error(source.string(), "cannot be copied to " + folder.string() + " (" + error.message() + ")",
                  "check the permissions and the free space");
    }
    return source.filename().string();
  }
  std::string name = image_name(frame_id);
  write_grey_png(folder / name, frame.grey.view());
  return name;
}

Image<float> rectified_image(const Dataset& dataset, std::int64_t frame_id, const FramePreprocessor& preprocessor) {
  const PreparedFrame frame = preprocessor.process(dataset.read(static_cast<int>(frame_id)));
  const Image<Texel>& texels = frame.pyramid.levels.front();
  Image<float> image(texels.width(), texels.height());
  for (std::size_t i = 0; i < image.size(); ++i) image.data()[i] = texels.data()[i].intensity;
  return image;
}

/// Of all keyframes; the grey levels are those of the camera. Returns the names.
std::vector<std::string> write_images(const RecordedMap& map, const Dataset& dataset, ColmapImages images,
                                      const fs::path& folder) {
  create_folder(folder);
  Calibration calibration;
  calibration.camera = dataset.calibration().camera;
  calibration.rectification = dataset.calibration().rectification;
  const FramePreprocessor preprocessor(calibration, PhotometrySettings{});
  std::vector<std::string> names;
  for (const protocol::Keyframe& keyframe : map.keyframes) {
    if (images == ColmapImages::kOriginal) {
      names.push_back(write_original(dataset, keyframe.id, folder));
    } else {
      names.push_back(image_name(keyframe.id));
      write_grey_png(folder / names.back(), rectified_image(dataset, keyframe.id, preprocessor).view());
    }
  }
  return names;
}

CameraCalibration pinhole(const PinholeIntrinsics& camera) {
  return {CameraModelKind::kPinhole, camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy, {}};
}

}  // namespace

ColmapModel make_colmap_model(const PlacedMap& placed, const CameraCalibration& camera,
                              const std::vector<std::string>& names) {
  const auto model_of_lens = make_camera_model(camera);
  const std::vector<protocol::Keyframe>& keyframes = placed.map.keyframes;
  ColmapModel model;
  model.camera = camera;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const Sim3d& S = placed.poses[i];
    model.images.push_back({names[i], SE3d(S.rotation(), S.translation()), {}});
  }
  const std::vector<std::vector<std::size_t>> seen_by = companions(placed.map);
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const protocol::Keyframe& keyframe = keyframes[i];
    for (std::size_t k = 0; k < keyframe.points.size(); ++k) {
      if (!(keyframe.depth_stddev[k] <= placed.most_deviation)) continue;
      const Eigen::Vector3d position = placed.poses[i] * keyframe.points[k].cast<double>();
      for (const std::size_t other : seen_by[i]) {
        const Eigen::Vector3d in_camera = model.images[other].T_world_camera.inverse() * position;
        if (!(in_camera.z() > 0)) continue;
        const Eigen::Vector2d pixel = model_of_lens->project(in_camera);
        if (pixel.allFinite() && is_inside(pixel, camera))
          model.images[other].observations.push_back({pixel, model.points.size()});
      }
      model.points.push_back({position, keyframe.intensity[k]});
    }
  }
  return model;
}

void export_colmap(const fs::path& folder, const FinishedRun& run, const PlacedMap& placed, ColmapImages images) {
  CameraCalibration camera = pinhole(run.camera);
  std::vector<std::string> names;
  if (images == ColmapImages::kNone) {
    for (const protocol::Keyframe& keyframe : placed.map.keyframes) names.push_back(image_name(keyframe.id));
  } else {
    const std::unique_ptr<Dataset> dataset = open_sequence(run);
    if (images == ColmapImages::kOriginal) camera = dataset->calibration().camera;
    names = write_images(placed.map, *dataset, images, folder / "images");
  }
  write_colmap_model(folder / "sparse" / "0", make_colmap_model(placed, camera, names));
}

}  // namespace ldso
