#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/calibration/foreign_camera.h"
#include "io/calibration/lens.h"
#include "io/text/text_file.h"
#include "ldso/error.h"

namespace ldso {
namespace {

/// What is between `<name ...>` and `</name>`: OpenCV's XML has neither nested elements of one name nor entities in
/// numbers, so that no parser of XML is needed.
std::optional<std::string_view> element(std::string_view text, const std::string& name) {
  for (std::size_t at = text.find("<" + name); at != std::string_view::npos; at = text.find("<" + name, at + 1)) {
    const std::size_t behind = at + 1 + name.size();
    if (behind >= text.size() || (text[behind] != '>' && text[behind] != ' ')) continue;
    const std::size_t begin = text.find('>', behind);
    const std::size_t end = text.find("</" + name + ">", behind);
    if (begin == std::string_view::npos || end == std::string_view::npos || end < begin) return std::nullopt;
    return text.substr(begin + 1, end - begin - 1);
  }
  return std::nullopt;
}

std::vector<double> numbers_in(std::string_view text, const std::string& where) {
  constexpr std::string_view kBlanks = " \t\r\n";
  std::vector<double> numbers;
  for (std::size_t begin = text.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
    std::string_view word = text.substr(begin, end - begin);
    if (word.ends_with('.')) word.remove_suffix(1);  // OpenCV writes "5." for 5.
    if (!parse_number(word, numbers.emplace_back()))
      throw Error(where, "'" + std::string(word) + "' is not a number", "OpenCV's FileStorage is expected");
    begin = text.find_first_not_of(kBlanks, end);
  }
  return numbers;
}

/// Of the first of several names that is there; empty if none is.
std::vector<double> numbers_of_any(std::string_view text, const std::vector<std::string>& names,
                                   const std::string& where) {
  for (const std::string& name : names) {
    if (const auto content = element(text, name))
      return numbers_in(element(*content, "data").value_or(*content), where);
  }
  return {};
}

}  // namespace

ForeignCamera read_xml_camera(const std::filesystem::path& path, int camera) {
  check_camera(camera, 1, path.string());
  const std::string text = read_text(path);
  ForeignCamera result;
  result.kind = "OpenCV FileStorage";
  result.where = path.string();
  const auto numbers = [&](const std::vector<std::string>& names) { return numbers_of_any(text, names, result.where); };
  const auto first_or_zero = [](const std::vector<double>& values) { return values.empty() ? 0.0 : values.front(); };
  OpenCvCamera values;
  values.matrix = numbers({"camera_matrix", "cameraMatrix", "Camera_Matrix", "intrinsic_matrix", "K", "M1"});
  if (values.matrix.empty())
    throw Error(path.string(), "has no camera_matrix", "OpenCV's FileStorage of a calibrated camera is expected");
  values.distortion =
      numbers({"distortion_coefficients", "distCoeffs", "Distortion_Coefficients", "dist_coeffs", "D", "D1"});
  values.width = first_or_zero(numbers({"image_width", "image_Width", "imageWidth", "width"}));
  values.height = first_or_zero(numbers({"image_height", "image_Height", "imageHeight", "height"}));
  values.is_fisheye = first_or_zero(numbers({"fisheye_model"})) != 0;
  result.camera = to_camera(values, result.where);
  return result;
}

CameraCalibration to_camera(const OpenCvCamera& values, const std::string& where) {
  if (values.matrix.size() != 9)
    throw Error(where, "the camera matrix has " + std::to_string(values.matrix.size()) + " numbers",
                "nine are expected: fx 0 cx 0 fy cy 0 0 1");
  CameraCalibration camera;
  set_size(camera, values.width, values.height, where);
  set_intrinsics(camera, values.matrix[0], values.matrix[4], values.matrix[2], values.matrix[5], where);
  set_lens(camera, values.is_fisheye ? "fisheye" : "opencv", values.distortion, where);
  return camera;
}

}  // namespace ldso
