#include "io/calibration/lens.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "io/text/text_file.h"
#include "ldso/error.h"

namespace ldso {
namespace {

constexpr double kMostFovAngle = 3.14;

struct NamedLens {
  const char* name;
  CameraModelKind kind;
  std::size_t least, most;  ///< Coefficients.
};

constexpr std::array<NamedLens, 24> kNamedLenses{{
    {"none", CameraModelKind::kPinhole, 0, 5},
    {"pinhole", CameraModelKind::kPinhole, 0, 0},
    {"simple_pinhole", CameraModelKind::kPinhole, 0, 0},
    {"radtan", CameraModelKind::kRadTan, 4, 5},
    {"radial-tangential", CameraModelKind::kRadTan, 4, 5},
    {"plumb_bob", CameraModelKind::kRadTan, 4, 5},
    {"rational_polynomial", CameraModelKind::kRadTan, 8, 8},
    {"pinhole-radtan8", CameraModelKind::kRadTan, 8, 8},
    {"opencv", CameraModelKind::kRadTan, 4, 14},
    {"full_opencv", CameraModelKind::kRadTan, 8, 8},
    {"simple_radial", CameraModelKind::kRadTan, 1, 1},
    {"radial", CameraModelKind::kRadTan, 2, 2},
    {"equidistant", CameraModelKind::kKannalaBrandt, 4, 4},
    {"equi", CameraModelKind::kKannalaBrandt, 4, 4},
    {"fisheye", CameraModelKind::kKannalaBrandt, 4, 4},
    {"opencv_fisheye", CameraModelKind::kKannalaBrandt, 4, 4},
    {"kb4", CameraModelKind::kKannalaBrandt, 4, 4},
    {"kannalabrandt8", CameraModelKind::kKannalaBrandt, 4, 4},
    {"fov", CameraModelKind::kFov, 1, 1},
    {"ds", CameraModelKind::kDoubleSphere, 2, 2},
    {"eucm", CameraModelKind::kEucm, 2, 2},
    {"ucm", CameraModelKind::kEucm, 1, 1},
    {"simple_radial_fisheye", CameraModelKind::kKannalaBrandt, 1, 1},
    {"radial_fisheye", CameraModelKind::kKannalaBrandt, 2, 2},
}};

const NamedLens& lens_named(const std::string& name, const std::string& where) {
  const std::string lower = to_lower(name);
  const auto found =
      std::find_if(kNamedLenses.begin(), kNamedLenses.end(), [&](const NamedLens& lens) { return lower == lens.name; });
  if (found != kNamedLenses.end()) return *found;
  throw Error(where, "the lens model '" + name + "' is unknown here",
              "radtan, rational, equidistant, fov, double sphere and eucm are known; calibrate with one of these");
}

[[noreturn]] void fail_count(const std::string& name, std::size_t count, const std::string& where) {
  throw Error(where, "the lens model '" + name + "' has " + std::to_string(count) + " coefficients",
              "radtan has 4, 5 or 8 (k1 k2 p1 p2 k3 k4 k5 k6), equidistant 4, fov 1, ds and eucm 2");
}

}  // namespace

void set_lens(CameraCalibration& camera, const std::string& name, const std::vector<double>& coefficients,
              const std::string& where) {
  const NamedLens& lens = lens_named(name, where);
  std::vector<double> k = coefficients;
  if (lens.kind == CameraModelKind::kRadTan && k.empty()) k.assign(4, 0);
  if (k.size() < lens.least || k.size() > lens.most) fail_count(name, k.size(), where);
  // Behind the denominator OpenCV has thin prisms and a tilted sensor.
  if (lens.kind == CameraModelKind::kPinhole || k.size() > 8) {
    const std::size_t known = lens.kind == CameraModelKind::kPinhole ? 0 : 8;
    if (std::any_of(k.begin() + static_cast<std::ptrdiff_t>(known), k.end(), [](double v) { return v != 0; }))
      fail_count(name, k.size(), where);
    k.resize(known);
  }
  if (lens.kind == CameraModelKind::kRadTan && (k.size() == 6 || k.size() == 7)) fail_count(name, k.size(), where);
  camera.model = lens.kind;
  for (std::size_t i = 0; i < k.size(); ++i) (i < 4 ? camera.distortion[i] : camera.more_distortion[i - 4]) = k[i];
  if (to_lower(name) == "ucm") camera.distortion[1] = 1;
  check_spheres(camera, where);
  simplify(camera);
}

void simplify(CameraCalibration& camera) {
  constexpr std::array<double, 4> kZero{};
  const bool may_be = camera.model == CameraModelKind::kFov || camera.model == CameraModelKind::kRadTan;
  if (may_be && camera.distortion == kZero && camera.more_distortion == kZero) camera.model = CameraModelKind::kPinhole;
}

void check_spheres(const CameraCalibration& camera, const std::string& where) {
  const auto& k = camera.distortion;
  if (camera.model == CameraModelKind::kFov && !(k[0] >= 0 && k[0] < kMostFovAngle))
    throw Error(where, "omega is out of range", "the field of view in radians is expected, 0 <= omega < pi");
  if (camera.model == CameraModelKind::kDoubleSphere && !(std::abs(k[0]) < 1 && k[1] >= 0 && k[1] <= 1))
    throw Error(where, "the double sphere's xi or alpha is out of range",
                "-1 < xi < 1 and 0 <= alpha <= 1 are expected");
  if (camera.model == CameraModelKind::kEucm && !(k[0] >= 0 && k[0] <= 1 && k[1] > 0 && k[1] < 1e3))
    throw Error(where, "the EUCM's alpha or beta is out of range", "0 <= alpha <= 1 and beta > 0 are expected");
}

}  // namespace ldso
