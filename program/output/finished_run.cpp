#include "output/finished_run.h"

#include <array>
#include <nlohmann/json.hpp>

#include "io/text/json_text.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"
#include "output/run_files.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

PinholeIntrinsics camera_of(const Json& json) {
  return {json_value<int>(json.at("width")),
          json_value<int>(json.at("height")),
          json.at("fx"),
          json.at("fy"),
          json.at("cx"),
          json.at("cy")};
}

/// `self_calibration.camera` of run.json.
std::optional<CameraCalibration> lens_of(const Json& json) {
  if (!json.contains("width")) return std::nullopt;
  CameraCalibration camera;
  const auto name = json.at("model").get<std::string>();
  for (const CameraModelKind kind :
       {CameraModelKind::kPinhole, CameraModelKind::kFov, CameraModelKind::kRadTan, CameraModelKind::kKannalaBrandt,
        CameraModelKind::kDoubleSphere, CameraModelKind::kEucm}) {
    if (name == model_name(kind)) camera.model = kind;
  }
  const PinholeIntrinsics pinhole = camera_of(json);
  camera.width = pinhole.width;
  camera.height = pinhole.height;
  camera.fx = pinhole.fx;
  camera.fy = pinhole.fy;
  camera.cx = pinhole.cx;
  camera.cy = pinhole.cy;
  camera.distortion = json.at("distortion").get<std::array<double, 4>>();
  camera.more_distortion = json.at("more_distortion").get<std::array<double, 4>>();
  camera.readout_ms = json.at("readout_ms");
  return camera;
}

DatasetOptions options_of(const Json& sequence) {
  DatasetOptions options;
  options.start = json_value<int>(sequence.at("start"));
  if (!sequence.at("end").is_null()) options.end = json_value<int>(sequence.at("end"));
  options.stride = json_value<int>(sequence.at("stride"));
  options.reverse = sequence.at("reverse");
  // Runs of older versions do not say these.
  if (sequence.contains("calib") && !sequence["calib"].is_null())
    options.calibration_file = sequence["calib"].get<std::string>();
  if (sequence.contains("fps") && !sequence["fps"].is_null()) options.fps = sequence["fps"].get<double>();
  if (sequence.contains("mask") && !sequence["mask"].is_null()) options.mask = sequence["mask"].get<std::string>();
  if (sequence.contains("pattern")) options.pattern = sequence["pattern"].get<std::string>();
  if (sequence.contains("topic")) options.topic = sequence["topic"].get<std::string>();
  return options;
}

}  // namespace

FinishedRun read_finished_run(const fs::path& folder) {
  const fs::path path = folder / kRunJson;
  if (!fs::exists(path))
    throw Error(folder.string(), "there is no finished run", "give the folder of an `ldso run -o`");
  FinishedRun run;
  run.folder = folder;
  try {
    const Json json = parse_json<Json>(read_file(path), path.string());
    const Json& sequence = json.at("sequence");
    run.sequence = sequence.at("path").get<std::string>();
    run.options = options_of(sequence);
    run.camera = camera_of(sequence.at("estimated_camera"));
    run.lens = lens_of(json.at("self_calibration").at("camera"));
    if (json.contains("scale") && !json["scale"].is_null()) run.metres_per_unit = json["scale"].at("metres_per_unit");
    if (json.contains("segments")) run.own_maps = json["segments"].size();
    if (!(run.metres_per_unit > 0)) throw Error(path.string(), "the scale is not positive", "run the sequence again");
    if (json.at("self_calibration").at("corrected").get<bool>()) run.options.calibration_file = folder / "camera.txt";
  } catch (const Json::exception& error) {
    throw Error(path.string(), std::string("it is damaged (") + error.what() + ")", "run the sequence again");
  }
  return run;
}

std::unique_ptr<Dataset> open_sequence(const FinishedRun& run) {
  if (!fs::exists(run.sequence)) {
    throw Error(run.sequence.string(), "the sequence of the run in " + run.folder.string() + " is not there",
                "say where it is now by --sequence, or go without its images by --images none");
  }
  return open_dataset(run.sequence, run.options);
}

}  // namespace ldso
