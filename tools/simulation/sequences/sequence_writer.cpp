#include "simulation/sequences/sequence_writer.h"

#include <yaml-cpp/yaml.h>
#include <zip.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <system_error>
#include <vector>

#include "io/images/image_file.h"
#include "io/text/output_folder.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"
#include "simulation/sequences/sequence_layout.h"
#include "util/whole_file.h"

namespace ldso::simulation {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDescription = "world.yaml";
constexpr const char* kDescriptionBeginning = "world: ";
constexpr const char* kDepthFolder = "depth/";

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
  if (!recipe.style.empty()) entry(out, "style", recipe.style);
  if (!recipe.motion.empty()) entry(out, "motion", recipe.motion);
  if (!recipe.tag.empty()) entry(out, "tag", recipe.tag);
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
  write_png(path, image.view());
}

/// Names of the frames that a folder contains.
std::vector<std::string> frame_files(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string stem = entry.path().stem().string();
    const bool digits = stem.size() >= 5 && stem.find_first_not_of("0123456789") == std::string::npos;
    if (digits && entry.path().extension() == ".png") names.push_back(entry.path().filename().string());
  }
  return names;
}

void remove_frames(const fs::path& folder) {
  std::error_code error;
  for (const std::string& name : frame_files(folder)) {
    if (!fs::remove(folder / name, error) && error)
      throw Error((folder / name).string(), "cannot be removed (" + error.message() + ")", "remove it");
  }
}

[[noreturn]] void fail(zip_t* archive, const fs::path& path) {
  const std::string reason = archive != nullptr ? zip_strerror(archive) : "cannot be created";
  if (archive != nullptr) zip_discard(archive);
  throw Error(path.string(), reason, "check the folder and the free space");
}

/// Puts the images into an archive, uncompressed (they are PNG), and removes them.
void pack(const fs::path& images, const fs::path& archive_path) {
  std::vector<std::string> names = frame_files(images);
  std::sort(names.begin(), names.end());
  zip_t* archive = zip_open(archive_path.string().c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr);
  if (archive == nullptr) fail(nullptr, archive_path);
  for (const std::string& name : names) {
    zip_source_t* source = zip_source_file(archive, (images / name).string().c_str(), 0, -1);
    const zip_int64_t index = source != nullptr ? zip_file_add(archive, name.c_str(), source, ZIP_FL_ENC_UTF_8) : -1;
    if (index < 0) fail(archive, archive_path);
    if (zip_set_file_compression(archive, static_cast<zip_uint64_t>(index), ZIP_CM_STORE, 0) < 0)
      fail(archive, archive_path);
  }
  if (zip_close(archive) < 0) fail(archive, archive_path);
  remove_frames(images);
}

/// The folder of a sequence, whose files may all be written: those of an earlier one are removed, but for the frames.
OutputFolder open_sequence_folder(const fs::path& folder, const SequenceLayout& layout) {
  OutputFolder out(folder);
  std::vector<std::string> names = layout.names(folder);
  names.insert(names.end(), {kDepthFolder, kDescription});
  std::error_code error;
  if (!out.has_list() && fs::exists(folder / kDescription, error)) {
    refuse_other_file(folder / kDescription, {kDescriptionBeginning}, "the description of a rendered sequence");
    out.adopt(names);
  }
  out.check(names);
  for (const std::string& name : names) out.remove(name);
  for (const std::string& name : layout.names(folder)) out.file(name);
  return out;
}

/// An empty folder of frames.
void make_frame_folder(const fs::path& folder) {
  create_folder(folder);
  remove_frames(folder);
}

/// Without depth maps there are none of an earlier sequence either.
void prepare_depth(OutputFolder& out, bool is_wanted) {
  if (is_wanted || out.owns(kDepthFolder)) make_frame_folder(out.file(kDepthFolder));
  if (!is_wanted) out.remove(kDepthFolder);
}

std::unique_ptr<SequenceLayout> layout_of(const WriteOptions& options) {
  if (options.layout != LayoutKind::kTumMono && (options.zip || options.truth_at_ends)) {
    throw Error("layout", "archives and ground truth at the ends belong to TUM-mono", "leave --zip and --truth out");
  }
  switch (options.layout) {
    case LayoutKind::kTumMono:
      return make_tum_mono_layout(options.truth_at_ends);
    case LayoutKind::kEuroc:
      return make_euroc_layout();
    case LayoutKind::kKitti:
      return make_kitti_layout();
  }
  throw Error("layout", "there is no such layout", "choose one of LayoutKind");
}

}  // namespace

double depth_unit(const SequenceRecipe& recipe) {
  return recipe.world == "street" || recipe.world == "eight" ? 0.01 : 0.001;
}

int write_sequence(const SimulatedSequence& sequence, const SequenceRecipe& recipe, const fs::path& folder,
                   const WriteOptions& options, ThreadPool& pool, const std::function<bool(int)>& progress) {
  const std::unique_ptr<SequenceLayout> layout = layout_of(options);
  layout->check(sequence, folder);
  const fs::path images = folder / layout->image_folder(), depth = folder / kDepthFolder;
  OutputFolder out = open_sequence_folder(folder, *layout);
  make_frame_folder(images);
  prepare_depth(out, options.depth);
  // Whole frames in parallel: no thread waits for another within a frame.
  int done = 0;
  bool go_on = true;
  const int batch = 4 * pool.threads();
  while (done < sequence.size() && go_on) {
    const int count = std::min(batch, sequence.size() - done);
    pool.run(count, [&](int i) {
      const int index = done + i;
      const std::string name = layout->frame_name(sequence, index) + ".png";
      const RawFrame frame = sequence.render(index);
      write_grey_png(images / name, frame.grey.view());
      if (options.depth) write_depth(depth / name, sequence.depth(index), depth_unit(recipe));
    });
    done += count;
    if (progress) go_on = progress(done);
  }
  if (options.zip) {
    pack(images, folder / "images.zip");
    out.remove("images/");
  }
  layout->write(folder, sequence, recipe, done);
  write_description(out.file(kDescription), sequence, recipe, done);
  return done;
}

}  // namespace ldso::simulation
