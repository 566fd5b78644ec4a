#include "calibration/lens/calibration_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "ldso/io/calibration_file.h"

namespace ldso {
namespace {

/// With as many digits as its deviation leaves meaning to, and one more.
std::string number_text(double value, double deviation) {
  const int digits = deviation > 0 ? std::clamp(static_cast<int>(std::ceil(1 - std::log10(deviation))), 0, 9) : 6;
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

std::string parameter_lines(const LensCalibration& lens) {
  const std::vector<std::string> names = lens_parameter_names(lens.kind);
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double deviation = lens.deviations.size() > 0 ? lens.deviations[k] : 0;
    text += "  " + padded(names[i], 6) + padded(number_text(lens.parameters[k], deviation), 14) +
            (deviation > 0 ? "+- " + number_text(deviation, deviation) : "") + "\n";
  }
  return text;
}

nlohmann::ordered_json view_json(const CalibratedView& view) {
  return {{"frame", view.frame},
          {"name", view.name},
          {"points", view.points.size()},
          {"rms_px", view.rms},
          {"distance_m", view.pose.translation().norm()}};
}

}  // namespace

std::string calibration_text(const LensCalibration& lens, const std::vector<LensCalibration>& others,
                             const std::vector<std::string>& advice) {
  std::string text = lens_name(lens.kind) + ", " + std::to_string(lens.camera.width) + "x" +
                     std::to_string(lens.camera.height) + ", from " + std::to_string(lens.point_count()) +
                     " points in " + std::to_string(lens.views.size()) + " views (values and standard deviations):\n" +
                     parameter_lines(lens) + "reprojection error " + number_text(lens.rms, lens.rms / 10) +
                     " px (RMS)\n";
  for (const std::string& name : lens.refused_views)
    text += "refused: " + name + " fits to no lens that fits the others\n";
  if (lens.refused_points > 0) text += "refused: " + std::to_string(lens.refused_points) + " single points\n";
  for (const LensCalibration& other : others) {
    if (other.kind == lens.kind) continue;
    text += "  with " + padded(lens_name(other.kind), 15) + number_text(other.rms, other.rms / 10) + " px\n";
  }
  for (const std::string& line : advice) text += "advice: " + line + "\n";
  return text;
}

nlohmann::ordered_json calibration_json(const LensCalibration& lens, const Board& board,
                                        const std::vector<LensCalibration>& others,
                                        const std::vector<std::string>& advice) {
  nlohmann::ordered_json json{{"model", lens_name(lens.kind)},
                              {"board", board_text(board)},
                              {"width", lens.camera.width},
                              {"height", lens.camera.height}};
  const std::vector<std::string> names = lens_parameter_names(lens.kind);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    json["parameters"][names[i]] = lens.parameters[k];
    if (lens.deviations.size() > 0) json["standard_deviations"][names[i]] = lens.deviations[k];
  }
  json["rms_px"] = lens.rms;
  json["points"] = lens.point_count();
  json["refused_points"] = lens.refused_points;
  json["refused_views"] = lens.refused_views;
  for (const LensCalibration& other : others) json["models"][lens_name(other.kind)] = {{"rms_px", other.rms}};
  json["views"] = nlohmann::ordered_json::array();
  for (const CalibratedView& view : lens.views) json["views"].push_back(view_json(view));
  json["advice"] = advice;
  return json;
}

std::string calibrated_camera_text(const LensCalibration& lens, int longest_side) {
  Calibration calibration;
  calibration.camera = lens.camera;
  const double scale =
      std::min(1.0, static_cast<double>(longest_side) / std::max(lens.camera.width, lens.camera.height));
  calibration.rectification.mode = RectificationMode::kCrop;
  calibration.rectification.width = std::max(1, static_cast<int>(std::lround(lens.camera.width * scale)));
  calibration.rectification.height = std::max(1, static_cast<int>(std::lround(lens.camera.height * scale)));
  return camera_file_text(calibration);
}

}  // namespace ldso
