#include "ldso/io/calibration_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <system_error>
#include <vector>

#include <Eigen/LU>

#include "io/calibration/calibration_doubts.h"
#include "io/calibration/camera_choice.h"
#include "io/calibration/foreign_calibration.h"
#include "io/calibration/lens.h"
#include "io/images/image_file.h"
#include "io/images/image_header.h"
#include "io/text/text_file.h"
#include "ldso/error.h"

namespace ldso {
namespace {

/// Of the FOV model [rad], whose radius is infinite at pi.
constexpr double kMostOmega = 3.14;

constexpr int kLargestSide = 32768;
constexpr double kLongestReadoutMs = 200;
constexpr const char* kFifthLine = "four lines are expected, and perhaps `rolling_shutter MS` as the fifth";

struct ModelLayout {
  const char* name;
  CameraModelKind kind;
  int parameters;  ///< Beside fx fy cx cy.
  const char* expected;
};

constexpr std::array<ModelLayout, 7> kModels{{
    {"FOV", CameraModelKind::kFov, 1, "FOV fx fy cx cy omega"},
    {"Pinhole", CameraModelKind::kPinhole, 1, "Pinhole fx fy cx cy 0"},
    {"RadTan", CameraModelKind::kRadTan, 4, "RadTan fx fy cx cy k1 k2 p1 p2`, with `k3` or `k3 k4 k5 k6` behind it"},
    {"KannalaBrandt", CameraModelKind::kKannalaBrandt, 4, "KannalaBrandt fx fy cx cy k1 k2 k3 k4"},
    {"EquiDistant", CameraModelKind::kKannalaBrandt, 4, "EquiDistant fx fy cx cy k1 k2 k3 k4"},
    {"DoubleSphere", CameraModelKind::kDoubleSphere, 2, "DoubleSphere fx fy cx cy xi alpha"},
    {"EUCM", CameraModelKind::kEucm, 2, "EUCM fx fy cx cy alpha beta"},
}};

/// By RectificationMode.
constexpr std::array<const char*, 4> kModes{"none", "crop", "full", "explicit"};

constexpr const char* kKnownModels =
    "`fx fy cx cy omega` or one of FOV, Pinhole, RadTan, KannalaBrandt, EquiDistant, DoubleSphere, EUCM with its "
    "parameters is expected";

const ModelLayout& layout_of(CameraModelKind kind) {
  return *std::find_if(kModels.begin(), kModels.end(), [=](const ModelLayout& layout) { return layout.kind == kind; });
}

std::string size_text(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

/// The layout that line 1 names; without a name the FOV model is meant. `first` is the index of fx.
const ModelLayout& layout_of(const TextFile& file, const TextLine& line, std::size_t& first) {
  double ignored = 0;
  first = 0;
  if (parse_number(line.fields.front(), ignored)) {
    if (line.fields.size() == 5) return kModels[0];
    file.fail(line, std::to_string(line.fields.size()) + " numbers without the name of a model", kKnownModels);
  }
  first = 1;
  for (const ModelLayout& layout : kModels) {
    if (to_lower(line.fields.front()) == to_lower(layout.name)) return layout;
  }
  file.fail(line, "unknown camera model '" + line.fields.front() + "'", kKnownModels);
}

void check_distortion(const TextFile& file, const TextLine& line, CameraCalibration& camera) {
  const double omega = camera.distortion[0];
  if (camera.model == CameraModelKind::kPinhole && omega != 0) {
    file.fail(line, "a pinhole camera has no distortion", "expected `Pinhole fx fy cx cy 0`");
  }
  if (camera.model == CameraModelKind::kFov && (omega < 0 || omega >= kMostOmega)) {
    file.fail(line, "omega is " + std::to_string(omega), "the field of view in radians is expected, 0 <= omega < pi");
  }
  check_spheres(camera, file.path().string() + ":" + std::to_string(line.number));
  simplify(camera);
}

/// How many numbers behind fx fy cx cy a model may have.
bool takes(const ModelLayout& layout, std::size_t count) {
  if (layout.kind == CameraModelKind::kPinhole && count == 0) return true;
  if (layout.kind == CameraModelKind::kRadTan && (count == 5 || count == 8)) return true;
  return count == static_cast<std::size_t>(layout.parameters);
}

CameraCalibration parse_camera(const TextFile& file, const TextLine& line) {
  std::size_t first = 0;
  const ModelLayout& layout = layout_of(file, line, first);
  const std::size_t count = line.fields.size() - first;
  if (count < 4 || !takes(layout, count - 4)) {
    file.fail(line, "the " + std::string(layout.name) + " model has " + std::to_string(count) + " numbers",
              "expected `" + std::string(layout.expected) + "`");
  }
  CameraCalibration camera;
  camera.model = layout.kind;
  camera.fx = file.finite_number(line, first);
  camera.fy = file.finite_number(line, first + 1);
  camera.cx = file.finite_number(line, first + 2);
  camera.cy = file.finite_number(line, first + 3);
  for (std::size_t i = 4; i < count; ++i)
    (i < 8 ? camera.distortion[i - 4] : camera.more_distortion[i - 8]) = file.finite_number(line, first + i);
  if (!(camera.fx > 0 && camera.fy > 0)) {
    file.fail(line, "a focal length is not positive", "expected `" + std::string(layout.expected) + "`");
  }
  check_distortion(file, line, camera);
  return camera;
}

void parse_size(const TextFile& file, const TextLine& line, int& width, int& height) {
  const double w = file.finite_number(line, 0);
  const double h = line.fields.size() == 2 ? file.finite_number(line, 1) : 0.0;
  const auto is_side = [](double v) { return v >= 1 && v <= kLargestSide && v == std::floor(v); };
  if (line.fields.size() != 2 || !is_side(w) || !is_side(h)) {
    file.fail(line, "'" + line.text + "' is no image size", "width and height in pixels are expected, `640 480`");
  }
  if (w * h > static_cast<double>(kMostImagePixels)) {
    file.fail(line, "'" + line.text + "' are more pixels than can be handled", "at most 8192x8192 are possible");
  }
  width = static_cast<int>(w);
  height = static_cast<int>(h);
}

/// Both are CameraCalibration or PinholeIntrinsics with their size set. True if they were relative.
template <class Intrinsics>
bool make_absolute(Intrinsics& camera) {
  if (camera.cx >= 1 || camera.cy >= 1) return false;
  camera.fx *= camera.width;
  camera.fy *= camera.height;
  camera.cx = camera.cx * camera.width - 0.5;
  camera.cy = camera.cy * camera.height - 0.5;
  return true;
}

PinholeIntrinsics parse_explicit(const TextFile& file, const TextLine& line) {
  const std::string expected = "`crop`, `full`, `none` or the intrinsics `fx fy cx cy 0` are expected";
  double ignored = 0;
  if (!parse_number(line.fields.front(), ignored)) {
    file.fail(line, "unknown rectification '" + line.fields.front() + "'", expected);
  }
  if (line.fields.size() != 4 && line.fields.size() != 5) {
    file.fail(line, "has " + std::to_string(line.fields.size()) + " numbers", expected);
  }
  if (line.fields.size() == 5 && file.finite_number(line, 4) != 0) {
    file.fail(line, "rectified images have no distortion, but the fifth number is not 0", expected);
  }
  PinholeIntrinsics intrinsics;
  intrinsics.fx = file.finite_number(line, 0);
  intrinsics.fy = file.finite_number(line, 1);
  intrinsics.cx = file.finite_number(line, 2);
  intrinsics.cy = file.finite_number(line, 3);
  if (!(intrinsics.fx > 0 && intrinsics.fy > 0)) file.fail(line, "a focal length is not positive", expected);
  return intrinsics;
}

RectificationMode parse_mode(const TextLine& line) {
  const std::string word = line.fields.size() == 1 ? to_lower(line.fields.front()) : "";
  if (word == "crop") return RectificationMode::kCrop;
  if (word == "full") return RectificationMode::kFull;
  if (word == "none") return RectificationMode::kNone;
  return RectificationMode::kExplicit;
}

Rectification parse_rectification(const TextFile& file, const CameraCalibration& camera) {
  const TextLine& mode_line = file.lines()[2];
  const TextLine& size_line = file.lines()[3];
  Rectification rectification;
  rectification.mode = parse_mode(mode_line);
  parse_size(file, size_line, rectification.width, rectification.height);
  if (rectification.mode == RectificationMode::kExplicit) {
    rectification.explicit_intrinsics = parse_explicit(file, mode_line);
    rectification.explicit_intrinsics.width = rectification.width;
    rectification.explicit_intrinsics.height = rectification.height;
    const PinholeIntrinsics& wanted = rectification.explicit_intrinsics;
    doubt_mixed_units(wanted.fx, wanted.fy, wanted.cx, wanted.cy,
                      file.path().string() + ":" + std::to_string(mode_line.number));
    make_absolute(rectification.explicit_intrinsics);
  }
  if (rectification.mode != RectificationMode::kNone) return rectification;
  if (camera.model != CameraModelKind::kPinhole) {
    file.fail(mode_line, "'none' is only possible without distortion", "use `crop` or `full`");
  }
  if (rectification.width != camera.width || rectification.height != camera.height) {
    file.fail(size_line, "with 'none' the images keep their size " + size_text(camera.width, camera.height),
              "write that size, or `crop` in the line above");
  }
  return rectification;
}

double parse_readout(const TextFile& file, const TextLine& line) {
  if (to_lower(line.fields.front()) != "rolling_shutter" || line.fields.size() != 2) {
    file.fail(line, "'" + line.text + "' is unknown here", kFifthLine);
  }
  const double readout_ms = file.finite_number(line, 1);
  if (std::abs(readout_ms) <= kLongestReadoutMs) return readout_ms;
  file.fail(line, "a readout of " + line.fields[1] + " ms is out of range",
            "the time from the first row to the last in milliseconds is expected, at most 200");
}

}  // namespace

const char* model_name(CameraModelKind kind) { return layout_of(kind).name; }

std::string camera_file_text(const Calibration& calibration) {
  const CameraCalibration& camera = calibration.camera;
  const Rectification& rectification = calibration.rectification;
  const PinholeIntrinsics& wanted = rectification.explicit_intrinsics;
  std::ostringstream out = number_stream();
  const ModelLayout& layout = layout_of(camera.model);
  out << layout.name << ' ' << camera.fx << ' ' << camera.fy << ' ' << camera.cx << ' ' << camera.cy;
  for (int i = 0; i < layout.parameters; ++i) out << ' ' << camera.distortion.at(static_cast<std::size_t>(i));
  if (camera.more_distortion != std::array<double, 4>{}) {
    for (const double k : camera.more_distortion) out << ' ' << k;
  }
  out << '\n' << camera.width << ' ' << camera.height << '\n';
  if (rectification.mode == RectificationMode::kExplicit) {
    out << wanted.fx << ' ' << wanted.fy << ' ' << wanted.cx << ' ' << wanted.cy << " 0\n";
  } else {
    out << kModes.at(static_cast<std::size_t>(rectification.mode)) << '\n';
  }
  out << (rectification.width > 0 ? rectification.width : camera.width) << ' '
      << (rectification.height > 0 ? rectification.height : camera.height) << '\n';
  if (camera.readout_ms != 0) out << "rolling_shutter " << camera.readout_ms << '\n';
  return out.str();
}

std::string describe(const CameraCalibration& camera, const Rectification& rectification) {
  return std::string(model_name(camera.model)) + " " + size_text(camera.width, camera.height) + " -> " +
         kModes.at(static_cast<std::size_t>(rectification.mode)) + " " +
         size_text(rectification.width > 0 ? rectification.width : camera.width,
                   rectification.height > 0 ? rectification.height : camera.height);
}

Calibration read_camera_calibration(const std::filesystem::path& path) {
  const CameraChoice choice = choose_camera(path);
  if (auto foreign = read_foreign_calibration(choice.file, choice.camera)) return *std::move(foreign);
  if (choice.camera) throw Error(path.string(), "a camera.txt holds one camera", "give " + choice.file.string());
  const TextFile file(path);
  if (file.lines().size() < 4) {
    throw Error(path.string(), "has " + std::to_string(file.lines().size()) + " lines, four are expected",
                "1: camera model and intrinsics, 2: image width and height, 3: crop, full, none or intrinsics, "
                "4: output width and height");
  }
  if (file.lines().size() > 5) file.fail(file.lines()[5], "is one line too many", kFifthLine);
  Calibration calibration;
  calibration.camera = parse_camera(file, file.lines()[0]);
  parse_size(file, file.lines()[1], calibration.camera.width, calibration.camera.height);
  if (file.lines().size() == 5) calibration.camera.readout_ms = parse_readout(file, file.lines()[4]);
  const CameraCalibration& c = calibration.camera;
  const std::string first_line = path.string() + ":" + std::to_string(file.lines()[0].number);
  doubt_mixed_units(c.fx, c.fy, c.cx, c.cy, first_line);
  const bool relative = make_absolute(calibration.camera);
  doubt_intrinsics(c, first_line, calibration.warnings);
  calibration.rectification = parse_rectification(file, calibration.camera);
  calibration.description = path.string() + ": " + describe(calibration.camera, calibration.rectification) +
                            (relative ? ", relative intrinsics" : ", absolute intrinsics");
  return calibration;
}

std::array<float, 256> read_inverse_response(const std::filesystem::path& path) {
  const TextFile file(path, /*comma_separated=*/true);
  std::vector<double> values;
  for (const TextLine& line : file.lines()) {
    for (std::size_t i = 0; i < line.fields.size(); ++i) {
      values.push_back(file.finite_number(line, i));
      if (values.size() > 1 && values.back() < values[values.size() - 2]) {
        file.fail(line, "value " + std::to_string(values.size()) + " is less than the one before",
                  "an inverse response does not decrease");
      }
    }
  }
  if (values.size() != 256) {
    throw Error(path.string(), "has " + std::to_string(values.size()) + " values",
                "256 are expected, one for each grey level");
  }
  const double range = values.back() - values.front();
  if (!(range > 0)) throw Error(path.string(), "all values are the same", "an increasing table is expected");
  std::array<float, 256> response{};
  for (std::size_t i = 0; i < response.size(); ++i) {
    response[i] = static_cast<float>(255.0 * (values[i] - values.front()) / range);
    if (i > 0 && response[i] <= response[i - 1]) {
      response[i] = std::nextafter(response[i - 1], std::numeric_limits<float>::infinity());
    }
  }
  return response;
}

void read_photometric_calibration(const std::filesystem::path& folder, Calibration& calibration) {
  std::error_code error;
  const std::filesystem::path response = folder / "pcalib.txt";
  const std::filesystem::path vignette = folder / "vignette.png";
  if (std::filesystem::exists(response, error)) {
    calibration.photometric.inverse_response = read_inverse_response(response);
    calibration.description += ", pcalib.txt";
  }
  if (std::filesystem::exists(vignette, error)) {
    calibration.photometric.vignette = read_vignette(vignette);
    calibration.description += ", vignette.png";
  }
}

std::map<std::string, Eigen::Matrix<double, 3, 4>> read_kitti_calibration(const std::filesystem::path& path) {
  const TextFile file(path);
  std::map<std::string, Eigen::Matrix<double, 3, 4>> matrices;
  for (const TextLine& line : file.lines()) {
    std::string name = line.fields.front();
    if (name.front() != 'P') continue;
    if (name.back() == ':') name.pop_back();
    if (line.fields.size() != 13) {
      file.fail(line, "has " + std::to_string(line.fields.size() - 1) + " numbers",
                "expected `" + name + ":` and the 12 numbers of a 3x4 projection matrix");
    }
    Eigen::Matrix<double, 3, 4>& P = matrices[name];
    for (int i = 0; i < 12; ++i) P(i / 4, i % 4) = file.finite_number(line, static_cast<std::size_t>(i + 1));
    if (!(P(0, 0) > 0 && P(1, 1) > 0)) file.fail(line, "a focal length is not positive", "");
    const Eigen::Vector3d shift = P.leftCols<3>().inverse() * P.col(3);
    if (!shift.allFinite())
      file.fail(line, "the first three columns cannot be inverted", "a camera matrix is expected");
  }
  if (matrices.empty()) throw Error(path.string(), "has no projection matrix", "expected a line `P0:` and 12 numbers");
  return matrices;
}

}  // namespace ldso
