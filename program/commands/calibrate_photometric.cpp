#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/photometric/response.h"
#include "calibration/photometric/vignette.h"
#include "commands/calibrate_commands.h"
#include "io/images/image_file.h"
#include "io/text/output_folder.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"
#include "ldso/io/dataset.h"
#include "output/run_files.h"
#include "terminal/progress_bar.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

constexpr const char* kResponseName = "pcalib.txt";
constexpr const char* kVignetteName = "vignette.png";

/// Frames of a video of the wall that are looked at.
constexpr int kPlaneFrames = 300;

struct PhotometricArguments {
  fs::path out;
  std::optional<fs::path> sweep, wall, camera, known_response;
  std::string board;
};

using KnownResponse = std::optional<std::array<double, 256>>;

std::unique_ptr<Dataset> open_uncalibrated(const fs::path& path) {
  DatasetOptions options;
  options.uncalibrated = true;
  return open_dataset(path, options);
}

OutputFolder open_photometric_folder(const PhotometricArguments& a) {
  for (const auto& input : {a.sweep, a.wall}) {
    if (input) refuse_output_in_input(a.out, *input, {});
  }
  OutputFolder out(a.out);
  if (a.sweep) out.check({kResponseName});
  if (a.wall) out.check({kVignetteName});
  return out;
}

std::vector<ExposedImage> read_sweep(const fs::path& path) {
  const auto dataset = open_uncalibrated(path);
  std::vector<ExposedImage> images;
  for (int i = 0; i < dataset->size(); ++i) {
    const RawFrame frame = dataset->read(i);
    if (!(frame.exposure_ms.value_or(0) > 0))
      throw Error(frame.name, "its exposure time is not known",
                  "write times.txt beside the images: a line `id timestamp exposure_ms` for each");
    images.push_back({*frame.exposure_ms, sampled_levels(frame.grey.view())});
  }
  return images;
}

std::array<double, 256> find_response(const PhotometricArguments& a, OutputFolder& out) {
  const ResponseEstimate estimate = estimate_response(read_sweep(*a.sweep), a.sweep->string());
  const fs::path file = out.file(kResponseName);
  write_file(file, response_text(estimate.inverse_response));
  std::cout << file.string() << ": response from " << estimate.levels_seen << " of 256 grey levels, " << estimate.rms
            << " levels off (RMS)\n";
  return estimate.inverse_response;
}

std::vector<PlaneView> read_wall(const Dataset& dataset, const ObservedPlane& plane) {
  ProgressBar bar(false, 1000000);
  const int count = std::min(kPlaneFrames, dataset.size());
  std::vector<PlaneView> views;
  for (int i = 0; i < count; ++i) {
    const RawFrame frame = dataset.read(static_cast<int>(static_cast<long long>(i) * dataset.size() / count));
    if (auto view = plane.view(frame.grey.view())) {
      view->exposure_ms = frame.exposure_ms;
      views.push_back(std::move(*view));
    }
    bar.update(i + 1, count, "looking at the wall");
  }
  return views;
}

void check_size(const Dataset& dataset, const CameraCalibration& camera, const fs::path& path) {
  const Image<float> first = dataset.read(0).grey;
  if (first.width() == camera.width && first.height() == camera.height) return;
  throw Error(path.string(),
              "its images are " + std::to_string(first.width()) + "x" + std::to_string(first.height()) +
                  ", the calibration is of " + std::to_string(camera.width) + "x" + std::to_string(camera.height),
              "give the --calib of these images");
}

void find_vignette(const PhotometricArguments& a, const KnownResponse& response, OutputFolder& out) {
  if (!a.camera || a.board.empty())
    throw Error("--vignette", "the board on the wall and the camera are needed", "give --board and --calib");
  const Board board = parse_board(a.board, "--board");
  const Calibration calibration = read_camera_calibration(*a.camera);
  const auto camera = make_camera_model(calibration.camera);
  const auto dataset = open_uncalibrated(*a.wall);
  check_size(*dataset, calibration.camera, *a.wall);
  const ObservedPlane plane(board, *camera, response);
  const std::vector<PlaneView> views = read_wall(*dataset, plane);
  const VignetteEstimate estimate =
      estimate_vignette(views, plane.cells(), calibration.camera.width, calibration.camera.height, a.wall->string());
  Image<float> scaled = estimate.vignette;
  for (std::size_t i = 0; i < scaled.size(); ++i) scaled.data()[i] *= 255;
  const fs::path file = out.file(kVignetteName);
  write_grey16_png(file, scaled.view());
  std::cout << file.string() << ": vignette from " << views.size() << " images, "
            << std::lround(100 * estimate.seen_share) << " % of the image seen, " << 100 * estimate.rms
            << " % off (RMS), exposure times " << (estimate.exposures_known ? "as given" : "estimated") << "\n";
}

void run_photometric(const PhotometricArguments& a) {
  if (!a.sweep && !a.wall)
    throw Error("ldso calibrate photometric", "there is nothing to calibrate from",
                "give --response with an exposure sweep, --vignette with a board on a wall, or both");
  OutputFolder out = open_photometric_folder(a);
  KnownResponse response;
  if (a.known_response) {
    response.emplace();
    const std::array<float, 256> known = read_inverse_response(*a.known_response);
    std::copy(known.begin(), known.end(), response->begin());
  }
  if (a.sweep) response = find_response(a, out);
  if (a.wall) find_vignette(a, response, out);
}

}  // namespace

void add_photometric_command(CLI::App& calibrate) {
  const auto a = std::make_shared<PhotometricArguments>();
  CLI::App* command = calibrate.add_subcommand(
      "photometric", "Measure response and vignette: pcalib.txt and vignette.png as in the TUM-mono benchmark");
  command->add_option("--response", a->sweep,
                      "Images of a still scene with many exposure times, which times.txt tells (third column, ms)");
  command->add_option("--vignette", a->wall, "Images or video of a board on an evenly coloured wall, from all sides");
  command->add_option("--board", a->board, "The board on the wall, as `ldso calibrate --board` has it");
  command->add_option("--calib", a->camera, "Camera of the images of the wall");
  CLI::Option* known = command->add_option("--pcalib", a->known_response, "Response that is known, for the vignette");
  known->excludes(command->get_option("--response"));
  command->add_option("-o,--out", a->out, "Folder for pcalib.txt and vignette.png")->required();
  command->callback([a] { run_photometric(*a); });
}

}  // namespace ldso
