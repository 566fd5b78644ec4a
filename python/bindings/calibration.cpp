// The camera: Calibration and the file formats it comes in.

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings/bindings.h"
#include "ldso/calibration.h"
#include "ldso/error.h"
#include "ldso/io/calibration_file.h"
#include "util/whole_file.h"

namespace ldso::python {

namespace py = pybind11;
using py::literals::operator""_a;

namespace {

constexpr std::array<std::pair<const char*, CameraModelKind>, 6> kModels{{
    {"pinhole", CameraModelKind::kPinhole},
    {"fov", CameraModelKind::kFov},
    {"radtan", CameraModelKind::kRadTan},
    {"kannala-brandt", CameraModelKind::kKannalaBrandt},
    {"double-sphere", CameraModelKind::kDoubleSphere},
    {"eucm", CameraModelKind::kEucm},
}};

CameraModelKind model_of(const std::string& name) {
  for (const auto& [word, kind] : kModels) {
    if (name == word) return kind;
  }
  throw Error("model " + name, "there is no such camera model",
              "take pinhole, fov, radtan, kannala-brandt, double-sphere or eucm");
}

std::string model_word(CameraModelKind kind) {
  return std::find_if(kModels.begin(), kModels.end(), [=](const auto& model) { return model.second == kind; })->first;
}

RectificationMode rectification_of(const std::string& name) {
  if (name == "none") return RectificationMode::kNone;
  if (name == "crop") return RectificationMode::kCrop;
  if (name == "full") return RectificationMode::kFull;
  throw Error("rectification " + name, "there is no such way to rectify", "take none, crop or full");
}

Calibration make_calibration(int width, int height, double fx, double fy, double cx, double cy,
                             const std::string& model, const std::vector<double>& distortion, double readout_ms,
                             const std::string& rectification) {
  Calibration made;
  CameraCalibration& camera = made.camera;
  camera = {model_of(model), width, height, fx, fy, cx, cy, {}, readout_ms, {}};
  const std::size_t most = camera.model == CameraModelKind::kRadTan ? 8 : 4;
  if (distortion.size() > most) {
    throw Error("distortion", std::to_string(distortion.size()) + " coefficients are too many",
                "pass at most " + std::to_string(most));
  }
  for (std::size_t i = 0; i < distortion.size(); ++i)
    (i < 4 ? camera.distortion[i] : camera.more_distortion[i - 4]) = distortion[i];
  const bool is_straight = camera.model == CameraModelKind::kPinhole;
  made.rectification.mode = rectification.empty() ? (is_straight ? RectificationMode::kNone : RectificationMode::kCrop)
                                                  : rectification_of(rectification);
  made.description = "made in Python";
  return made;
}

Calibration read_from_file(const std::filesystem::path& path, bool photometric) {
  Calibration calibration = read_camera_calibration(path);
  if (photometric) read_photometric_calibration(path.parent_path().empty() ? "." : path.parent_path(), calibration);
  return calibration;
}

py::object response_array(const Calibration& calibration) {
  const auto& response = calibration.photometric.inverse_response;
  if (!response) return py::none();
  return py::array_t<float>(static_cast<py::ssize_t>(response->size()), response->data());
}

void set_inverse_response(Calibration& calibration, const std::optional<py::array_t<float>>& values) {
  calibration.photometric.inverse_response.reset();
  if (!values) return;
  if (values->ndim() != 1 || values->shape(0) != 256)
    throw Error("inverse_response", "it has not 256 values", "pass the irradiance of each grey level, 0..255");
  std::array<float, 256>& response = calibration.photometric.inverse_response.emplace();
  for (std::size_t i = 0; i < response.size(); ++i) response[i] = values->at(static_cast<py::ssize_t>(i));
}

py::object vignette_array(const Calibration& calibration) {
  const Image<float>& image = calibration.photometric.vignette;
  if (image.empty()) return py::none();
  return py::array_t<float>({image.height(), image.width()}, image.data());
}

void set_vignette(Calibration& calibration,
                  const std::optional<py::array_t<float, py::array::c_style | py::array::forcecast>>& values) {
  calibration.photometric.vignette = {};
  if (!values) return;
  if (values->ndim() != 2) throw Error("vignette", "it is no image", "pass an array of shape (height, width)");
  Image<float> image(static_cast<int>(values->shape(1)), static_cast<int>(values->shape(0)));
  std::copy_n(values->data(), image.size(), image.data());
  calibration.photometric.vignette = std::move(image);
}

std::vector<double> all_distortion(const CameraCalibration& camera) {
  std::vector<double> all(camera.distortion.begin(), camera.distortion.end());
  if (camera.model == CameraModelKind::kRadTan)
    all.insert(all.end(), camera.more_distortion.begin(), camera.more_distortion.end());
  return all;
}

void bind_pinhole(py::module_& module) {
  py::class_<PinholeIntrinsics>(module, "PinholeIntrinsics",
                                "A camera without distortion; lengths in pixels, pixel centres at integers.")
      .def_readonly("width", &PinholeIntrinsics::width)
      .def_readonly("height", &PinholeIntrinsics::height)
      .def_readonly("fx", &PinholeIntrinsics::fx)
      .def_readonly("fy", &PinholeIntrinsics::fy)
      .def_readonly("cx", &PinholeIntrinsics::cx)
      .def_readonly("cy", &PinholeIntrinsics::cy)
      .def_property_readonly("K",
                             [](const PinholeIntrinsics& c) {
                               py::array_t<double> K({3, 3});
                               const double values[9] = {c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1};
                               std::copy_n(values, 9, K.mutable_data());
                               return K;
                             })
      .def("__repr__", [](const PinholeIntrinsics& c) {
        return py::str("PinholeIntrinsics({}x{}, fx={:.3f}, fy={:.3f}, cx={:.3f}, cy={:.3f})")
            .format(c.width, c.height, c.fx, c.fy, c.cx, c.cy);
      });
}

/// A number of the camera, to be read and set.
template <class T>
void add_number(py::class_<Calibration>& type, const char* name, T CameraCalibration::*member, const char* text) {
  type.def_property(
      name, [=](const Calibration& c) { return c.camera.*member; },
      [=](Calibration& c, T value) { c.camera.*member = value; }, text);
}

void add_photometry(py::class_<Calibration>& type) {
  type.def_property("inverse_response", &response_array, &set_inverse_response,
                    "Irradiance (0..255) of each of the 256 grey levels: float32 of shape (256,), or None.")
      .def_property("vignette", &vignette_array, &set_vignette,
                    "Attenuation in (0, 1]: float32 of shape (height, width), or None.");
}

}  // namespace

void bind_calibration(py::module_& module) {
  bind_pinhole(module);
  py::class_<Calibration> type(module, "Calibration",
                               "The camera as it took the images, and how they are rectified. Intrinsics in pixels, "
                               "pixel centres at integers.");
  type.def(py::init(&make_calibration), "width"_a, "height"_a, "fx"_a, "fy"_a, "cx"_a, "cy"_a, py::kw_only(),
           "model"_a = "pinhole", "distortion"_a = std::vector<double>(), "readout_ms"_a = 0.0, "rectification"_a = "",
           "model: pinhole, fov, radtan, kannala-brandt, double-sphere or eucm. distortion: its coefficients (radtan: "
           "OpenCV's k1 k2 p1 p2 [k3 [k4 k5 k6]]). readout_ms: of a rolling shutter, from the first row to the last. "
           "rectification: none (only pinhole), crop or full.");
  type.def_static("read", &read_from_file, "path"_a, "photometric"_a = true,
                  "Read camera.txt, or a calibration as Kalibr, ROS, OpenCV, ORB-SLAM, COLMAP, Basalt, nerfstudio or "
                  "KITTI wrote it; with `photometric` also pcalib.txt and vignette.png beside it, where they exist.");
  type.def(
      "write", [](const Calibration& c, const std::filesystem::path& path) { write_file(path, camera_file_text(c)); },
      "path"_a, "Write it as camera.txt.");
  type.def_property_readonly("model", [](const Calibration& c) { return model_word(c.camera.model); });
  type.def_property_readonly("distortion", [](const Calibration& c) { return all_distortion(c.camera); });
  add_number(type, "width", &CameraCalibration::width, "[px]");
  add_number(type, "height", &CameraCalibration::height, "[px]");
  add_number(type, "fx", &CameraCalibration::fx, "[px]");
  add_number(type, "fy", &CameraCalibration::fy, "[px]");
  add_number(type, "cx", &CameraCalibration::cx, "[px]");
  add_number(type, "cy", &CameraCalibration::cy, "[px]");
  add_number(type, "readout_ms", &CameraCalibration::readout_ms, "Rolling shutter: first row to last [ms]; 0: global.");
  add_photometry(type);
  type.def_readonly("description", &Calibration::description, "How it was read.");
  type.def_readonly("warnings", &Calibration::warnings, "What is doubtful about it: a list of str.");
  type.def("__str__", &camera_file_text);
  type.def("__repr__",
           [](const Calibration& c) { return "<ldso.Calibration " + describe(c.camera, c.rectification) + ">"; });
}

}  // namespace ldso::python
