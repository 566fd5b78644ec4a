#include "io/datasets/tum_rgbd_dataset.h"

#include <array>
#include <system_error>
#include <utility>
#include <vector>

#include "io/calibration/foreign_calibration.h"
#include "io/datasets/sequence_dataset.h"
#include "io/datasets/time_unit.h"
#include "io/text/text_file.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

struct FreiburgCamera {
  const char* long_name;
  const char* short_name;
  std::array<double, 8> parameters;  ///< fx fy cx cy k1 k2 p1 p2
};

// Cameras 1 and 2 were published with a third radial coefficient (k3 = 1.1633 and 0.9172). These are the parameters
// without it that come nearest to the published mapping over the whole image in the sense of least squares: 0.5 px rms,
// up to 6 px in the corners, where the published polynomial is extrapolated too. Camera 3 is published without
// distortion.
constexpr std::array<FreiburgCamera, 3> kFreiburgCameras{{
    {"freiburg1", "fr1", {524.712302, 524.068618, 318.652955, 255.349498, 0.032667, 0.008557, -0.005543, 0.002537}},
    {"freiburg2", "fr2", {526.669726, 526.940658, 325.157131, 249.722371, 0.052274, -0.030986, -0.003373, -0.000187}},
    {"freiburg3", "fr3", {535.4, 539.2, 320.1, 247.6, 0, 0, 0, 0}},
}};

Calibration to_calibration(const FreiburgCamera& freiburg) {
  Calibration calibration;
  CameraCalibration& camera = calibration.camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = freiburg.parameters[0];
  camera.fy = freiburg.parameters[1];
  camera.cx = freiburg.parameters[2];
  camera.cy = freiburg.parameters[3];
  std::copy_n(freiburg.parameters.begin() + 4, 4, camera.distortion.begin());
  const bool distorted = camera.distortion != std::array<double, 4>{};
  camera.model = distorted ? CameraModelKind::kRadTan : CameraModelKind::kPinhole;
  calibration.rectification.mode = distorted ? RectificationMode::kCrop : RectificationMode::kNone;
  calibration.description = "known calibration of the " + std::string(freiburg.long_name) +
                            " camera: " + describe(camera, calibration.rectification);
  return calibration;
}

Calibration read_calibration(const fs::path& folder, const DatasetOptions& options) {
  std::error_code error;
  if (options.calibration_file) return read_camera_calibration(*options.calibration_file);
  if (const fs::path own = find_calibration(folder); fs::exists(own, error)) return read_camera_calibration(own);
  const fs::path normal = fs::weakly_canonical(fs::absolute(folder));
  const fs::path name = normal.has_filename() ? normal.filename() : normal.parent_path().filename();
  if (auto known = freiburg_calibration(name.string())) return *std::move(known);
  throw Error((folder / "camera.txt").string(),
              "there is no calibration, and the folder's name does not say which Freiburg camera it was",
              "write camera.txt, give one with --calib, or have freiburg1, 2 or 3 in the folder's name");
}

std::vector<FrameEntry> read_frames(const fs::path& path, std::vector<std::string>& warnings) {
  const TextFile file(path);
  std::vector<FrameEntry> frames;
  std::vector<double> times;
  for (const TextLine& line : file.lines()) {
    if (line.fields.size() != 2)
      file.fail(line, "'" + line.text + "' is not understood", "expected `timestamp filename`");
    times.push_back(file.finite_number(line, 0));
    frames.push_back({line.fields[1], 0, std::nullopt});
  }
  convert_to_seconds(times, path, warnings);
  for (std::size_t i = 0; i < times.size(); ++i) frames[i].timestamp = times[i];
  return frames;
}

}  // namespace

bool is_tum_rgbd(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / "rgb.txt", error);
}

std::optional<Calibration> freiburg_calibration(const std::string& folder_name) {
  const std::string name = to_lower(folder_name);
  for (const FreiburgCamera& camera : kFreiburgCameras) {
    if (name.find(camera.long_name) != std::string::npos || name.find(camera.short_name) != std::string::npos) {
      return to_calibration(camera);
    }
  }
  return std::nullopt;
}

std::unique_ptr<Dataset> open_tum_rgbd(const fs::path& folder, const DatasetOptions& options) {
  Sequence sequence;
  sequence.format_name = "TUM RGB-D";
  sequence.location = folder.string();
  sequence.images = open_image_folder(folder);
  sequence.calibration = read_calibration(folder, options);
  sequence.frames = read_frames(folder / "rgb.txt", sequence.warnings);
  std::error_code error;
  const fs::path truth = folder / "groundtruth.txt";
  if (fs::exists(truth, error)) read_ground_truth(sequence, [&] { return read_tum_trajectory(truth); });
  return make_sequence_dataset(std::move(sequence));
}

}  // namespace ldso
