#include "simulation/sequence_writer.h"

#include <yaml-cpp/yaml.h>
#include <zip.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <limits>
#include <locale>
#include <sstream>
#include <utility>
#include <vector>

#include "io/image_file.h"
#include "io/text_file.h"
#include "io/trajectory_file.h"
#include "ldso/error.h"

namespace ldso::simulation {
namespace {

namespace fs = std::filesystem;

std::string frame_name(int index) {
  char name[16];
  std::snprintf(name, sizeof(name), "%05d", index);
  return name;
}

std::ostringstream number_stream() {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << std::setprecision(std::numeric_limits<double>::max_digits10);
  return out;
}

const char* model_name(CameraModelKind kind) {
  switch (kind) {
    case CameraModelKind::kPinhole:
      return "Pinhole";
    case CameraModelKind::kFov:
      return "FOV";
    case CameraModelKind::kRadTan:
      return "RadTan";
    case CameraModelKind::kKannalaBrandt:
      return "KannalaBrandt";
  }
  return "";
}

int distortion_fields(CameraModelKind kind) {
  return kind == CameraModelKind::kPinhole || kind == CameraModelKind::kFov ? 1 : 4;
}

std::string rectification_line(const Rectification& rectification) {
  std::ostringstream out = number_stream();
  const PinholeIntrinsics& k = rectification.explicit_intrinsics;
  switch (rectification.mode) {
    case RectificationMode::kNone:
      return "none";
    case RectificationMode::kCrop:
      return "crop";
    case RectificationMode::kFull:
      return "full";
    case RectificationMode::kExplicit:
      out << k.fx << ' ' << k.fy << ' ' << k.cx << ' ' << k.cy << " 0";
      return out.str();
  }
  return "none";
}

void write_camera(const fs::path& path, const Calibration& calibration) {
  const CameraCalibration& camera = calibration.camera;
  std::ostringstream out = number_stream();
  out << model_name(camera.model) << ' ' << camera.fx << ' ' << camera.fy << ' ' << camera.cx << ' ' << camera.cy;
  for (int i = 0; i < distortion_fields(camera.model); ++i) out << ' ' << camera.distortion[i];
  const Rectification& rectification = calibration.rectification;
  out << '\n' << camera.width << ' ' << camera.height << '\n' << rectification_line(rectification) << '\n';
  out << (rectification.width > 0 ? rectification.width : camera.width) << ' '
      << (rectification.height > 0 ? rectification.height : camera.height) << '\n';
  write_file(path, out.str());
}

void write_photometry(const fs::path& folder, const PhotometricCalibration& photometric) {
  if (photometric.inverse_response) {
    std::ostringstream out = number_stream();
    for (int i = 0; i < 256; ++i) out << (i > 0 ? " " : "") << (*photometric.inverse_response)[i];
    out << '\n';
    write_file(folder / "pcalib.txt", out.str());
  }
  if (!photometric.vignette.empty()) {
    Image<float> scaled = photometric.vignette;
    std::for_each(scaled.data(), scaled.data() + scaled.size(), [](float& v) { v *= 255; });
    write_grey16_png(folder / "vignette.png", std::as_const(scaled).view());
  }
}

void write_times(const fs::path& path, const SimulatedSequence& sequence, int frames, bool exposure) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << std::fixed << std::setprecision(9);
  for (int i = 0; i < frames; ++i) {
    out << frame_name(i) << ' ' << sequence.timestamp(i);
    if (exposure) out << ' ' << sequence.exposure_ms(i);
    out << '\n';
  }
  write_file(path, out.str());
}

void write_truth(const fs::path& path, const SimulatedSequence& sequence, int frames) {
  Trajectory trajectory;
  for (int i = 0; i < frames; ++i) trajectory.push_back({sequence.timestamp(i), sequence.T_world_camera(i)});
  write_tum_trajectory(path, trajectory);
}

template <class Value>
void entry(YAML::Emitter& out, const char* key, const Value& value) {
  out << YAML::Key << key << YAML::Value << value;
}

/// What was rendered, complete enough to render it again.
void write_description(const fs::path& path, const SimulatedSequence& sequence, const SequenceRecipe& recipe,
                       int frames) {
  YAML::Emitter out;
  out << YAML::BeginMap;
  entry(out, "world", recipe.world);
  entry(out, "seed", recipe.seed);
  entry(out, "frames", frames);
  entry(out, "path_length_m", sequence.path_length());
  entry(out, "fps", sequence.options().fps);
  entry(out, "scale", recipe.scale);
  entry(out, "speed", recipe.speed);
  entry(out, "models", recipe.models);
  entry(out, "texel_scale", recipe.texel_scale);
  if (recipe.trajectory) entry(out, "trajectory", recipe.trajectory->filename().string());
  entry(out, "depth_unit_m", depth_unit(recipe));
  const CameraCalibration& camera = sequence.calibration().camera;
  out << YAML::Key << "camera" << YAML::Value << YAML::BeginMap;
  entry(out, "model", model_name(camera.model));
  entry(out, "width", camera.width);
  entry(out, "height", camera.height);
  entry(out, "intrinsics", YAML::Node(std::vector<double>{camera.fx, camera.fy, camera.cx, camera.cy}));
  entry(out, "distortion", YAML::Node(std::vector<double>(camera.distortion.begin(), camera.distortion.end())));
  out << YAML::EndMap;
  const SensorOptions& sensor = recipe.sensor;
  out << YAML::Key << "sensor" << YAML::Value << YAML::BeginMap;
  entry(out, "response", sensor.response);
  entry(out, "vignette", sensor.vignette);
  entry(out, "calibration_provided", recipe.provide_calibration);
  entry(out, "exposure_changes", sensor.exposure_changes);
  entry(out, "exposure_ms", sensor.exposure_ms);
  entry(out, "exposure_provided", recipe.provide_exposure);
  entry(out, "read_noise", sensor.read_noise);
  entry(out, "shot_noise", sensor.shot_noise);
  entry(out, "motion_blur", sensor.motion_blur);
  entry(out, "rolling_shutter_ms", sensor.rolling_shutter_ms);
  out << YAML::EndMap << YAML::EndMap;
  write_file(path, std::string(out.c_str()) + "\n");
}

void write_depth(const fs::path& path, const Image<float>& depth, double unit) {
  Image<std::uint16_t> image(depth.width(), depth.height());
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const double units = std::round(depth.data()[i] / unit);
    image.data()[i] = units > 65535 ? std::uint16_t{0} : static_cast<std::uint16_t>(units);
  }
  write_png(path, std::as_const(image).view());
}

/// Names of the frames that a folder contains.
std::vector<std::string> frame_files(const fs::path& folder) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string(), stem = entry.path().stem().string();
    const bool digits = stem.size() == 5 && stem.find_first_not_of("0123456789") == std::string::npos;
    if (digits && entry.path().extension() == ".png") names.push_back(name);
  }
  return names;
}

[[noreturn]] void fail(zip_t* archive, const fs::path& path) {
  const std::string reason = archive != nullptr ? zip_strerror(archive) : "cannot be created";
  if (archive != nullptr) zip_discard(archive);
  throw Error(path.string(), reason, "check the folder and the free space");
}

/// Puts the images into an archive, uncompressed (they are PNG), and removes them.
void pack(const fs::path& images, const fs::path& archive_path, int frames) {
  fs::remove(archive_path);
  zip_t* archive = zip_open(archive_path.string().c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr);
  if (archive == nullptr) fail(nullptr, archive_path);
  for (int i = 0; i < frames; ++i) {
    const std::string name = frame_name(i) + ".png";
    zip_source_t* source = zip_source_file(archive, (images / name).string().c_str(), 0, -1);
    const zip_int64_t index = source != nullptr ? zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8) : -1;
    if (index < 0) fail(archive, archive_path);
    if (zip_set_file_compression(archive, static_cast<zip_uint64_t>(index), ZIP_CM_STORE, 0) < 0)
      fail(archive, archive_path);
  }
  if (zip_close(archive) < 0) fail(archive, archive_path);
  for (const std::string& name : frame_files(images)) fs::remove(images / name);
  if (fs::is_empty(images)) fs::remove(images);
}

/// An empty folder of frames: what an earlier run left there (files named by five digits) is removed.
void make_frame_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error(folder.string(), "cannot be made (" + error.message() + ")", "choose another folder");
  for (const std::string& name : frame_files(folder)) fs::remove(folder / name);
}

/// Removes what an earlier run wrote and this one does not.
void remove_leftovers(const fs::path& folder) {
  for (const char* name : {"images.zip", "pcalib.txt", "vignette.png"}) fs::remove(folder / name);
  const fs::path depth = folder / "depth";
  if (!fs::is_directory(depth)) return;
  for (const std::string& name : frame_files(depth)) fs::remove(depth / name);
  if (fs::is_empty(depth)) fs::remove(depth);
}

}  // namespace

double depth_unit(const SequenceRecipe& recipe) {
  return recipe.world == "street" || recipe.world == "eight" ? 0.01 : 0.001;
}

int write_sequence(const SimulatedSequence& sequence, const SequenceRecipe& recipe, const fs::path& folder,
                   const WriteOptions& options, ThreadPool& pool, const std::function<bool(int)>& progress) {
  const fs::path images = folder / "images";
  make_frame_folder(images);
  remove_leftovers(folder);
  if (options.depth) make_frame_folder(folder / "depth");
  write_camera(folder / "camera.txt", sequence.calibration());
  write_photometry(folder, sequence.calibration().photometric);
  // Whole frames in parallel: no thread waits for another within a frame.
  int done = 0;
  bool go_on = true;
  const int batch = 4 * pool.threads();
  while (done < sequence.size() && go_on) {
    const int count = std::min(batch, sequence.size() - done);
    pool.run(count, [&](int i) {
      const int index = done + i;
      const RawFrame frame = sequence.render(index);
      write_grey_png(images / (frame_name(index) + ".png"), frame.grey.view());
      if (options.depth)
        write_depth(folder / "depth" / (frame_name(index) + ".png"), sequence.depth(index), depth_unit(recipe));
    });
    done += count;
    if (progress) go_on = progress(done);
  }
  write_times(folder / "times.txt", sequence, done, recipe.provide_exposure);
  write_truth(folder / "groundtruth.txt", sequence, done);
  write_description(folder / "world.yaml", sequence, recipe, done);
  if (options.zip) pack(images, folder / "images.zip", done);
  return done;
}

}  // namespace ldso::simulation
